//! The report: the sections in their order below a table of what was found.

use crate::{Context, Finding, Name, Section, ValidationError};
use renderer::study::Chart;

/// The first lines of the report.
const HEAD: &str = "\
# Validation

Airlight beside published and independent answers. This page is written by one command, which also writes the points of its charts:

```sh
cargo run --release --bin airlight-validate                      # docs/validation.md and plots/validation-*.csv
cargo run --release --bin airlight-validate -- --only rayleigh   # one section, printed
cargo run --release --bin airlight-validate -- --check           # is this page what the program finds?
cargo run --release --bin airlight-tools -- chart plots/validation-*.csv
```

The references are in [validation/references](../validation/references/README.md), in `raw-data/` and in `tools/tests/reference/`, each with its source. \
Errors are found less reference, relative ones over the reference; bias is their mean (in radiative transfer weighed by the inverse square of \
the uncertainty), rms their root mean square, z a difference over the combined standard error. What fails is named in its \
section. The same program on the same kind of processor writes the same bytes again.
";

/// A section with its name.
pub type Named = (Name, Section);

/// Makes some sections; `begins` hears which one begins.
///
/// # Errors
/// The first [`ValidationError`].
pub fn sections(context: &Context<'_>, names: &[Name], begins: &dyn Fn(Name)) -> Result<Vec<Named>, ValidationError> {
    let make = |&name: &Name| {
        begins(name);
        Ok((name, name.make(context)?))
    };
    names.iter().map(make).collect()
}

/// The text of one section, with its heading.
#[must_use]
pub fn one(name: Name, section: &Section) -> String {
    format!("## {}\n\n{}\n", name.title(), section.text.trim())
}

/// The lines of findings as a table.
#[must_use]
pub fn findings<'a>(all: impl IntoIterator<Item = (Name, &'a Finding)>) -> String {
    let mut text = String::from("| section | compared | found | beside | verdict |\n|---|---|---|---|---|\n");
    for (name, Finding { what, found, beside, verdict }) in all {
        let anchor = name.title().to_lowercase().replace(' ', "-");
        text += &format!("| [{}](#{anchor}) | {what} | {found} | {beside} | {} |\n", name.title(), verdict.words());
    }
    text
}

/// The whole page.
#[must_use]
pub fn page(all: &[Named]) -> String {
    let lines = all.iter().flat_map(|(name, section)| section.findings.iter().map(|finding| (*name, finding)));
    let mut text = format!("{HEAD}\n{}", findings(lines));
    for (name, section) in all {
        text.push('\n');
        text += &one(*name, section);
    }
    text
}

/// The names of files below `plots/`, and their charts.
pub fn charts(all: &[Named]) -> impl Iterator<Item = (String, &Chart)> {
    all.iter().flat_map(|(_, section)| &section.charts).map(|(name, chart)| (format!("validation-{name}.csv"), chart))
}

/// Which of some sections a page does not hold as they are, with the table lines they belong to.
#[must_use]
pub fn missing(page: &str, all: &[Named]) -> Vec<Name> {
    let holds = |(name, section): &&Named| {
        let lines = findings(section.findings.iter().map(|finding| (*name, finding)));
        page.contains(&one(*name, section)) && lines.lines().skip(2).all(|line| page.contains(line))
    };
    all.iter().filter(|section| !holds(section)).map(|(name, _)| *name).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Verdict;

    #[test]
    fn a_page_holds_its_sections_and_no_others() {
        let mut section = Section::default();
        section.say("Text.");
        section.find("a", "b", "c", Verdict::Within);
        let mut other = section.clone();
        other.say("More.");
        let page = page(&[(Name::Mie, section.clone())]);
        assert_eq!(missing(&page, &[(Name::Mie, section.clone())]), []);
        assert_eq!(missing(&page, &[(Name::Mie, other), (Name::Rt, section)]), [Name::Mie, Name::Rt]);
    }
}
