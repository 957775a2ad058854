//! How much of a file an error quotes.

/// The most characters of a text that is quoted whole.
const MOST: usize = 600;

/// How many of a longer one from its beginning, and from its end, where parsers say the line.
const ENDS: (usize, usize) = (450, 100);

/// `text` if it is short, else its beginning, its end, and how long it is: an error stays a sentence whatever
/// stands in the file.
#[must_use]
pub fn excerpt(text: &str) -> String {
    if text.char_indices().nth(MOST).is_none() {
        return text.into();
    }
    let at = |(position, _): (usize, char)| position;
    let head = text.char_indices().nth(ENDS.0).map_or(text.len(), at);
    let tail = text.char_indices().nth_back(ENDS.1).map_or(0, at);
    format!("{}...{} ({} bytes)", &text[..head], &text[tail..], text.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn short_texts_are_quoted_whole_and_long_ones_cut_between_characters() {
        let short = "é".repeat(MOST);
        assert_eq!(excerpt(&short), short);
        let long = excerpt(&(short + &"ö".repeat(1_000_000)));
        assert_eq!(long, format!("{}...{} (2001200 bytes)", "é".repeat(450), "ö".repeat(101)));
    }
}
