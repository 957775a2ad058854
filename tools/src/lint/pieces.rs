//! A CSV text in pieces, so that a file of any length is judged in little memory.

use std::borrow::Cow;

/// The most rows, and fields, that are judged together: no file of `raw-data/` has as many, and what they take in
/// memory is small beside any file that has more.
const TOGETHER: (usize, usize) = (2500, 16_000);

/// Rows that a piece shares with the one before, so that what is wrong between them is seen.
const SHARED: usize = 3;

/// Rows that are judged together, under the header of their file.
pub(super) struct Piece<'a> {
    /// Header lines, header row, and the rows.
    pub(super) text: Cow<'a, str>,
    /// Lines up to the header row.
    head: u64,
    /// Lines between the header row and the rows.
    skipped: u64,
}

impl Piece<'_> {
    /// The line of the file that is `line` of the piece.
    pub(super) fn line(&self, line: u64) -> u64 {
        if line > self.head { line + self.skipped } else { line }
    }
}

/// The pieces of a CSV text: the text itself where it is no longer than one.
pub(super) struct Pieces<'a> {
    text: &'a str,
    /// Bytes and lines up to the header row.
    head: (usize, u64),
    /// Bytes and lines up to the rows that come next; none at the end.
    at: Option<(usize, u64)>,
    /// The most rows of a piece.
    most: usize,
}

impl<'a> Pieces<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        let mut head = (0, 0);
        let mut header = "";
        for line in text.split_inclusive('\n') {
            head = (head.0 + line.len(), head.1 + 1);
            header = line;
            if !line.trim_start_matches('\u{feff}').starts_with('#') {
                break;
            }
        }
        let fields = header.split([',', ';', '\t']).count();
        Self { text, head, at: Some(head), most: (TOGETHER.1 / fields).clamp(SHARED + 1, TOGETHER.0) }
    }
}

impl<'a> Iterator for Pieces<'a> {
    type Item = Piece<'a>;

    fn next(&mut self) -> Option<Piece<'a>> {
        let from = self.at.take()?;
        let (mut to, mut rows, mut open) = (from, 0, false);
        let mut shared = [from; SHARED];
        for line in self.text[from.0..].split_inclusive('\n') {
            if rows == self.most {
                self.at = Some(shared[0]);
                break;
            }
            if !open {
                shared.rotate_left(1);
                shared[SHARED - 1] = to;
            }
            to = (to.0 + line.len(), to.1 + 1);
            // A row ends with the line in which no quote is left open.
            open ^= line.matches('"').count() % 2 == 1;
            rows += usize::from(!open);
        }
        let whole = from == self.head && self.at.is_none();
        let text = if whole {
            Cow::Borrowed(self.text)
        } else {
            Cow::Owned([&self.text[..self.head.0], &self.text[from.0..to.0]].concat())
        };
        Some(Piece { text, head: self.head.1, skipped: from.1 - self.head.1 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn short_texts_are_one_piece_and_long_ones_share_rows_and_know_their_lines() {
        let short = "# title: t\nx,y\n1,2\n";
        let pieces: Vec<Piece<'_>> = Pieces::new(short).collect();
        assert!(pieces.len() == 1 && pieces[0].text == short && pieces[0].line(3) == 3);

        let rows = TOGETHER.0 * 2;
        let long: String =
            std::iter::once("# a: b\nx\n".to_owned()).chain((0..rows).map(|i| format!("{i}\n"))).collect();
        let mut next = 0;
        for piece in Pieces::new(&long) {
            let lines: Vec<&str> = piece.text.lines().collect();
            assert_eq!(lines[..2], ["# a: b", "x"]);
            let first: usize = lines[2].parse().expect("a number");
            assert!(first <= next && first + SHARED >= next, "{first} where {next} comes");
            // Row i stands in line i + 3 of the file, and first in line 3 of the piece.
            assert_eq!(piece.line(3), first as u64 + 3);
            next = first + lines.len() - 2;
        }
        assert_eq!(next, rows);
    }

    #[test]
    fn quoted_line_ends_do_not_end_a_row() {
        let text: String =
            std::iter::once("x\n".to_owned()).chain((0..TOGETHER.0 + 9).map(|i| format!("\"{i}\na\"\n"))).collect();
        for piece in Pieces::new(&text) {
            assert_eq!(piece.text.matches('"').count() % 2, 0, "a row was cut");
        }
    }
}
