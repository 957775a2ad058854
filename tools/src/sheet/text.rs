//! A sheet for people.

use super::{Series, Sheet, Values};
use crate::text::{aligned, six_digits};

impl Sheet {
    /// Title and settings, a block of aligned columns for each group, then tables and sources. The keys stand in every
    /// block; a row of which a block has no value, and one that says the same as the row before, are left out there.
    pub(super) fn text(&self, bare: bool) -> String {
        let mut text = String::new();
        if !bare {
            text += &format!("{}\n\n", self.title);
            let settings: Vec<_> = self.settings.iter().map(|(key, value)| vec![key.clone(), value.clone()]).collect();
            text += &aligned(&settings, 2, |_| false);
        }
        let mut groups: Vec<&str> = Vec::new();
        for group in self.columns.iter().filter_map(|column| column.group) {
            if !groups.contains(&group) {
                groups.push(group);
            }
        }
        for group in groups {
            if !text.is_empty() {
                text.push('\n');
            }
            let shown: Vec<&Series> = self.columns.iter().filter(|c| c.group.is_none_or(|g| g == group)).collect();
            let unit = |column: &&Series| if column.unit == "text" { String::new() } else { column.unit.clone() };
            let mut rows =
                vec![shown.iter().map(|column| column.label.clone()).collect(), shown.iter().map(unit).collect()];
            for row in (0..self.rows()).filter(|&row| shown.iter().any(|c| c.group.is_some() && has_value(c, row))) {
                let cells: Vec<String> = shown.iter().map(|column| cell(column, row)).collect();
                if rows.last() != Some(&cells) {
                    rows.push(cells);
                }
            }
            text += &format!("{group}\n");
            text += &aligned(&rows, 2, |i| matches!(shown[i].values, Values::Numbers(_)));
        }
        if !bare {
            text.push('\n');
            text += &self.sources.text();
        }
        text
    }
}

fn has_value(column: &Series, row: usize) -> bool {
    match &column.values {
        Values::Numbers(values) => values[row].is_some(),
        Values::Words(_) => true,
    }
}

fn cell(column: &Series, row: usize) -> String {
    match &column.values {
        // Keys as they were asked for; the rest to six digits.
        Values::Numbers(values) if column.group.is_none() => values[row].map_or("-".into(), crate::text::shortest),
        Values::Numbers(values) => values[row].map_or("-".into(), six_digits),
        Values::Words(words) => words[row].clone(),
    }
}
