//! Everything to look at in one page: what the tables hold, what they and the renderer are beside independent answers, the figures of `plots/`,
//! the pictures of the documents.
//!
//! The page is one HTML file that opens from disk: figures are inline SVG, pictures are in it as data, nothing is fetched and nothing is run. The same
//! files give the same bytes.

mod markdown;
mod numbers;

use crate::inspect;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use tables::TableError;

/// Why there is no report.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// A file or folder cannot be read.
    #[error("{}: cannot be read: {source}", path.display())]
    Read {
        /// It.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// A table that is none.
    #[error(transparent)]
    Table(#[from] TableError),
    /// A figure that may not be put into a page.
    #[error("{}: {why}", path.display())]
    Figure {
        /// It.
        path: PathBuf,
        /// Why.
        why: &'static str,
    },
}

/// Where the parts of a report are.
#[derive(Debug, Clone, Copy)]
pub struct Folders<'a> {
    /// The tables.
    pub data: &'a Path,
    /// The figures: SVG, and README.md with a row of each.
    pub plots: &'a Path,
    /// The documents with their pictures; validation.md is one of them.
    pub docs: &'a Path,
}

/// How the page looks.
const STYLE: &str = "\
body{margin:0 auto;max-width:72rem;padding:1rem 1.5rem 4rem;background:#fff;color:#222;font:16px/1.5 system-ui,sans-serif}\
h1,h2,h3{line-height:1.2}h2{margin-top:3rem;border-bottom:1px solid #ddd}\
figure{margin:2rem 0}figcaption{color:#444;font-size:.9rem}\
svg{width:100%;height:auto}img{max-width:100%;height:auto}\
details{padding:.15rem 0}table{border-collapse:collapse;margin:1rem 0;font-size:.85rem}caption{text-align:left;padding:.3rem 0}\
th,td{border:1px solid #ddd;padding:.15rem .5rem;text-align:right}pre{overflow-x:auto;background:#f6f6f6;padding:.7rem;font-size:.8rem}code{background:#f2f2f2}";

/// The page. Figures and pictures stand in the order of their names; what a figure shows is said by the row of `plots/README.md` that names it.
///
/// # Errors
/// [`ReportError`] with the first file that cannot be read, or holds what does not belong in a page.
pub fn html(folders: Folders<'_>) -> Result<String, ReportError> {
    let (tables, figures, pictures) = (tables(folders.data)?, figures(folders.plots)?, pictures(folders.docs)?);
    let validation = markdown::document(&String::from_utf8_lossy(&read(&folders.docs.join("validation.md"))?));
    Ok(format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width\">\n<title>Airlight</title>\n<style>{STYLE}</style>\n</head>\n<body>\n\
         <h1>Airlight {}</h1>\n<p><a href=\"#tables\">Tables</a> · <a href=\"#validation\">Validation</a> · <a href=\"#figures\">Figures</a> · <a href=\"#pictures\">Pictures</a></p>\n\
         <h2 id=\"tables\">Tables</h2>\n{tables}<h2 id=\"validation\">Validation</h2>\n{validation}<h2 id=\"figures\">Figures</h2>\n{figures}<h2 id=\"pictures\">Pictures</h2>\n{pictures}</body>\n</html>\n",
        env!("CARGO_PKG_VERSION")
    ))
}

/// The tables, a line each, and below it, folded, what it holds.
fn tables(folder: &Path) -> Result<String, ReportError> {
    let mut page = String::new();
    for path in files(folder, "table")? {
        let bytes = read(&path)?;
        let table = tables::file::decode(&bytes).map_err(|error| error.at(&path))?;
        let checksum = tables::file::checksum(&bytes).map_or(String::new(), |sum| format!(", checksum {sum:08x}"));
        let (name, title, text) = (stem(&path), escaped(&table.title), escaped(&inspect::describe(&table)));
        // Writing to a string does not fail.
        let _ = writeln!(
            page,
            "<details id=\"table-{0}\"><summary><b>{0}</b> {title} ({1:.1} kB{checksum})</summary><pre>{text}</pre>{2}</details>",
            escaped(&name),
            bytes.len() as f64 / 1e3,
            numbers::of(&table)
        );
    }
    Ok(page)
}

/// The figures, each with what it shows and its command.
fn figures(folder: &Path) -> Result<String, ReportError> {
    let readme = folder.join("README.md");
    let readme = if readme.is_file() { String::from_utf8_lossy(&read(&readme)?).into_owned() } else { String::new() };
    let mut page = String::new();
    for path in files(folder, "svg")? {
        let text = String::from_utf8_lossy(&read(&path)?).into_owned();
        let name = stem(&path);
        let _ = write!(
            page,
            "<figure id=\"{}\">\n{}\n<figcaption><b>{}</b>",
            escaped(&name),
            svg(&text, &path)?,
            escaped(&name)
        );
        if let Some([shows, command]) = row(&readme, &name) {
            let _ = write!(page, ": {} {}", markdown::line(&shows), markdown::line(&command));
        }
        page += "</figcaption>\n</figure>\n";
    }
    Ok(page)
}

/// What a figure shows, and its command: the row of a table of Markdown that names it. A name in the first cell may end in `*`, or begin with `-` to be added to the first.
fn row(readme: &str, name: &str) -> Option<[String; 2]> {
    readme.lines().find_map(|line| {
        let cells: Vec<&str> =
            line.strip_prefix('|')?.trim_end().trim_end_matches('|').split('|').map(str::trim).collect();
        let [names, shows, command] = cells[..] else { return None };
        let names: Vec<&str> = names.split('`').skip(1).step_by(2).collect();
        let first = *names.first()?;
        let is = |one: &&str| match (one.strip_suffix('*'), one.starts_with('-')) {
            (Some(begin), _) => name.starts_with(begin),
            (None, true) => name == format!("{first}{one}"),
            (None, false) => name == *one,
        };
        names.iter().any(is).then(|| [shows.to_owned(), command.to_owned()])
    })
}

/// The pictures that documents show, by document, each once.
fn pictures(folder: &Path) -> Result<String, ReportError> {
    let mut shown: BTreeMap<PathBuf, String> = BTreeMap::new();
    let mut page = String::new();
    for path in files(folder, "md")? {
        let text = String::from_utf8_lossy(&read(&path)?).into_owned();
        let title = text.lines().find_map(|line| line.strip_prefix("# ")).unwrap_or_default();
        let mut headed = false;
        for (caption, target) in images(&text) {
            let file = folder.join(target);
            // Figures stand above.
            if !file.is_file() || !target.starts_with("pictures/") || shown.contains_key(&file) {
                continue;
            }
            if !headed {
                let _ = writeln!(page, "<h3>{}</h3>", markdown::line(title));
                headed = true;
            }
            let image = match file.extension().and_then(|end| end.to_str()) {
                Some("svg") => svg(&String::from_utf8_lossy(&read(&file)?), &file)?.to_owned(),
                Some("png") => {
                    let data = base64(&read(&file)?);
                    format!("<img alt=\"{}\" src=\"data:image/png;base64,{data}\">", escaped(caption))
                }
                _ => continue,
            };
            let _ =
                writeln!(page, "<figure>\n{image}\n<figcaption>{}</figcaption>\n</figure>", markdown::line(caption));
            shown.insert(file, caption.to_owned());
        }
    }
    Ok(page)
}

/// The images of Markdown: what stands in their place, and where they are.
fn images(text: &str) -> Vec<(&str, &str)> {
    let parts = text.split("![").skip(1);
    parts
        .filter_map(|part| part.split_once("](").and_then(|(alt, rest)| Some((alt, rest.split_once(')')?.0))))
        .collect()
}

/// An SVG file as it stands in a page. It may run nothing.
fn svg<'a>(text: &'a str, path: &Path) -> Result<&'a str, ReportError> {
    let wrong = |why| ReportError::Figure { path: path.into(), why };
    let begin = text.find("<svg").ok_or_else(|| wrong("no SVG"))?;
    let lower = text.to_lowercase();
    // Attributes that run something begin with "on".
    if lower.contains("<script")
        || lower.contains(" on") && lower.contains("=\"javascript:")
        || lower.contains("<foreignobject")
    {
        return Err(wrong("an SVG that runs something: a report holds figures alone"));
    }
    Ok(text[begin..].trim_end())
}

/// Files of a folder with that ending, by name.
fn files(folder: &Path, ending: &str) -> Result<Vec<PathBuf>, ReportError> {
    let at = |source| ReportError::Read { path: folder.into(), source };
    let all = std::fs::read_dir(folder).map_err(at)?;
    let mut files = all.map(|entry| entry.map(|entry| entry.path())).collect::<Result<Vec<_>, _>>().map_err(at)?;
    files.retain(|path| path.extension().is_some_and(|end| end == ending));
    files.sort();
    Ok(files)
}

fn read(path: &Path) -> Result<Vec<u8>, ReportError> {
    std::fs::read(path).map_err(|source| ReportError::Read { path: path.into(), source })
}

fn stem(path: &Path) -> String {
    path.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

/// Text in HTML.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// Bytes in base 64 (RFC 4648, section 4): three of them are four characters, what is missing of the last is `=`.
fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for three in bytes.chunks(3) {
        let word = (0..3).fold(0_u32, |word, i| word << 8 | u32::from(three.get(i).copied().unwrap_or(0)));
        for place in 0..4 {
            let digit = DIGITS[(word >> (18 - 6 * place) & 63) as usize];
            text.push(if place > three.len() { '=' } else { char::from(digit) });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base_64_is_that_of_the_standard() {
        // RFC 4648, section 10.
        let vectors = ["", "Zg==", "Zm8=", "Zm9v", "Zm9vYg==", "Zm9vYmE=", "Zm9vYmFy"];
        for (length, expected) in vectors.into_iter().enumerate() {
            assert_eq!(base64(&b"foobar"[..length]), expected);
        }
        assert_eq!(base64(&[0xff, 0xef, 0xbe]), "/+++");
    }

    #[test]
    fn a_figure_is_found_by_its_name_its_beginning_or_its_end() {
        let readme = "| figure | shows | command |\n|---|---|---|\n| `sun` | light | `plot sun` |\n| `a`, `-day` | b | c |\n| `m-*` | d | e |\n";
        let shows = |name: &str| row(readme, name).map(|[shows, _]| shows);
        assert_eq!(shows("sun").as_deref(), Some("light"));
        assert_eq!((shows("a-day").as_deref(), shows("m-x").as_deref()), (Some("b"), Some("d")));
        assert_eq!(shows("day"), None);
    }

    #[test]
    fn pictures_are_found_and_nothing_of_a_figure_runs() {
        assert_eq!(images("x ![a b](pictures/a.png) y ![c](d.svg)"), [("a b", "pictures/a.png"), ("c", "d.svg")]);
        let path = Path::new("a.svg");
        assert_eq!(svg("<?xml?>\n<svg></svg>\n", path).expect("a figure"), "<svg></svg>");
        assert!(svg("<svg><script>x</script></svg>", path).is_err() && svg("none", path).is_err());
    }

    #[test]
    fn the_page_has_every_table_figure_and_picture_and_fetches_nothing() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let at = |name: &str| root.join(name);
        let (data, plots, docs) = (at("data"), at("plots"), at("docs"));
        let page = html(Folders { data: &data, plots: &plots, docs: &docs }).expect("a page");
        assert_eq!(page.matches("<details").count(), files(&data, "table").expect("tables").len());
        let figures = files(&plots, "svg").expect("figures");
        assert!(figures.iter().all(|figure| page.contains(&format!("<figure id=\"{}\">", stem(figure)))));
        assert!(page.contains("data:image/png;base64,") && page.ends_with("</html>\n"));
        assert!(page.contains("<h3>Radiative transfer</h3>") && page.contains("<code>number_density</code> in m^-3"));
        let fetched = ["<script", "<link", "src=\"http", "href=\"http", "url(http"];
        assert!(fetched.iter().all(|word| !page.contains(word)));
    }
}
