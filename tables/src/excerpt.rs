//! How much of a file an error quotes.

/// The most characters of a text that an excerpt holds.
const MOST: usize = 200;

/// `text` if it is short, else its first 200 characters and how long it is: an error stays a sentence whatever
/// stands in the file.
#[must_use]
pub fn excerpt(text: &str) -> String {
    match text.char_indices().nth(MOST) {
        None => text.into(),
        Some((end, _)) => format!("{}... ({} bytes)", &text[..end], text.len()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn short_texts_are_quoted_whole_and_long_ones_cut_between_characters() {
        let short = "é".repeat(MOST);
        assert_eq!(excerpt(&short), short);
        let long = excerpt(&"é".repeat(1_000_000));
        assert_eq!(long, format!("{short}... (2000000 bytes)"));
    }
}
