//! Markdown as HTML that fetches nothing and runs nothing.

use super::escaped;
use pulldown_cmark::{Event, HeadingLevel, Options, Parser, Tag, TagEnd, html};
use std::path::Path;

/// A document without its title. Of links the text is left, an image is a link to the figure of that name on the same page.
pub(super) fn document(text: &str) -> String {
    let rest = text.split_once('\n').filter(|(first, _)| first.starts_with("# ")).map_or(text, |(_, rest)| rest);
    written(events(rest).filter(|event| !matches!(event, Event::Start(Tag::Link { .. }) | Event::End(TagEnd::Link))))
}

/// A line: no paragraph, of links and images the text.
pub(super) fn line(text: &str) -> String {
    let inline = events(text).filter(|event| {
        !matches!(
            event,
            Event::Start(Tag::Paragraph | Tag::Link { .. } | Tag::Image { .. })
                | Event::End(TagEnd::Paragraph | TagEnd::Link | TagEnd::Image)
        )
    });
    written(inline)
}

fn events(text: &str) -> impl Iterator<Item = Event<'_>> {
    Parser::new_ext(text, Options::ENABLE_TABLES).map(|event| match event {
        Event::Html(raw) | Event::InlineHtml(raw) => Event::Text(raw),
        other => other,
    })
}

fn written<'a>(events: impl Iterator<Item = Event<'a>>) -> String {
    let mut page = String::new();
    let placed = |event| match event {
        Event::Start(Tag::Heading { level, id, classes, attrs }) => {
            Event::Start(Tag::Heading { level: lower(level), id, classes, attrs })
        }
        Event::End(TagEnd::Heading(level)) => Event::End(TagEnd::Heading(lower(level))),
        Event::Start(Tag::Image { dest_url, .. }) => {
            let name = Path::new(&*dest_url).file_stem().unwrap_or_default().to_string_lossy().into_owned();
            Event::InlineHtml(format!("<a href=\"#{}\">", escaped(&name)).into())
        }
        Event::End(TagEnd::Image) => Event::InlineHtml("</a>".into()),
        other => other,
    };
    html::push_html(&mut page, events.map(placed));
    page
}

/// Headings of a document stand below those of the page.
fn lower(level: HeadingLevel) -> HeadingLevel {
    HeadingLevel::try_from(level as usize + 1).unwrap_or(level)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_fetched_and_nothing_runs() {
        assert_eq!(line("a < `b & c` of [d](e.md)."), "a &lt; <code>b &amp; c</code> of d.");
        let text = "# T\n\n## A\n\n| a | b |\n|---|---|\n| 1 | [x](http://y) |\n\n![see](../plots/validation-rt.png)\n\n<script>z</script>\n";
        let page = document(text);
        assert!(page.contains("<h3>A</h3>") && page.contains("<td>1</td><td>x</td>"), "{page}");
        assert!(page.contains("<a href=\"#validation-rt\">see</a>") && !page.contains("<h1>"), "{page}");
        assert!(!page.contains("<script") && !page.contains("http"), "{page}");
    }
}
