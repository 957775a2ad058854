//! Names that people type.

/// The most bytes of a name that can be a slip of a known one.
const MAX_NAME: usize = 100;

/// The known name nearest to `name` (Jaro-Winkler similarity of at least 0.7); none is near to what is no name.
#[must_use]
pub fn nearest<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    if name.len() > MAX_NAME {
        return None;
    }
    let name = name.to_lowercase();
    known
        .into_iter()
        .map(|candidate| (strsim::jaro_winkler(&name, candidate), candidate))
        .filter(|(similarity, _)| *similarity >= 0.7)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, candidate)| candidate)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_misspelt_name_finds_its_neighbour() {
        let grounds = ["dry-soil", "ocean", "wet-soil"];
        assert_eq!(nearest("Oceen", grounds), Some("ocean"));
        assert_eq!(nearest("drysoil", grounds), Some("dry-soil"));
        assert_eq!(nearest("xyz", grounds), None);
    }
}
