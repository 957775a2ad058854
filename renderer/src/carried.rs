//! The tables of `data/` as they were when the program was built: it carries them, 9.5 MB, so that it runs from any folder.

/// Name and bytes of a table's file.
macro_rules! tables {
    ($($name:literal),* $(,)?) => {
        [$(($name, include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/../data/", $name)))),*]
    };
}

/// All of them.
const TABLES: [(&str, &[u8]); 26] = tables![
    "aerosol-jaenicke-background.table",
    "aerosol-jaenicke-desert-dust.table",
    "aerosol-jaenicke-maritime-clean.table",
    "aerosol-jaenicke-maritime-mineral.table",
    "aerosol-jaenicke-polar-antarctic.table",
    "aerosol-jaenicke-polar-arctic.table",
    "aerosol-jaenicke-remote-continental.table",
    "aerosol-jaenicke-rural.table",
    "aerosol-jaenicke-urban.table",
    "aerosol-opac-background.table",
    "aerosol-opac-desert-dust.table",
    "aerosol-opac-maritime-clean.table",
    "aerosol-opac-maritime-mineral.table",
    "aerosol-opac-polar-antarctic.table",
    "aerosol-opac-polar-arctic.table",
    "aerosol-opac-remote-continental.table",
    "aerosol-opac-rural.table",
    "aerosol-opac-urban.table",
    "ground-albedo.table",
    "observer.table",
    "ozone-cross-section.table",
    "ozone-layers.table",
    "ozone-profiles.table",
    "rayleigh.table",
    "standard-atmosphere.table",
    "sun.table",
];

/// The bytes of a table by the name of its file.
pub(crate) fn carried(name: &str) -> Option<&'static [u8]> {
    TABLES.iter().find(|(own, _)| *own == name).map(|(_, bytes)| *bytes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn every_table_of_the_folder_is_carried() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../data");
        let tables = std::fs::read_dir(&folder).expect("a folder").map(|entry| entry.expect("an entry").file_name());
        let mut names: Vec<String> = tables.map(|name| name.to_string_lossy().into_owned()).collect();
        names.retain(|name| name.ends_with(".table"));
        assert_eq!(names.len(), TABLES.len());
        for name in names {
            assert!(
                carried(&name).is_some_and(|bytes| bytes == std::fs::read(folder.join(&name)).expect("there")),
                "{name}"
            );
        }
        assert_eq!(carried("none.table"), None);
    }
}
