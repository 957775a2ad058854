//! The tables of `data/`, read once.

use std::path::{Path, PathBuf};
use tables::views::{
    GroundAlbedo, Observer, OzoneCrossSection, OzoneLayers, OzoneProfiles, Rayleigh, StandardAtmosphere, Sun,
};
use tables::{Kind, Table, TableError, file};

/// Every table that a picture can need, and the identity of each for its receipt.
#[derive(Debug, Clone)]
pub struct Data {
    /// Air against altitude.
    pub standard_atmosphere: StandardAtmosphere,
    /// How air scatters.
    pub rayleigh: Rayleigh,
    /// How ozone absorbs.
    pub ozone_cross_section: OzoneCrossSection,
    /// Ozone by month and latitude (McPeters-Labow).
    pub ozone_profiles: OzoneProfiles,
    /// Ozone by month in layers (Arosa, Ramanathan & Kulkarni).
    pub ozone_layers: OzoneLayers,
    /// The sun.
    pub sun: Sun,
    /// The eye.
    pub observer: Observer,
    /// Grounds by name.
    pub ground_albedo: GroundAlbedo,
    /// What was read, for the picture's attributes.
    pub identities: Vec<Identity>,
}

/// What identifies a table file that was read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Identity {
    /// File name below the data folder.
    pub file: String,
    /// Title in the file.
    pub title: String,
    /// [`file::checksum`] of the file.
    pub checksum: u32,
}

/// Why the tables of a folder cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum DataError {
    /// A table is not there.
    #[error("no table {file} in {}: run `airlight-tools build`, or name the folder with --data", folder.display())]
    Absent {
        /// The folder looked in.
        folder: PathBuf,
        /// The file missed.
        file: String,
    },
    /// A table is there and cannot be used.
    #[error(transparent)]
    Table(#[from] TableError),
}

impl Data {
    /// Reads every kind of table from `folder`.
    ///
    /// # Errors
    /// [`DataError`] with the first file that is absent or cannot be used, and why.
    pub fn load(folder: &Path) -> Result<Self, DataError> {
        let mut identities = Vec::new();
        let mut read = |kind: Kind| -> Result<Table, DataError> {
            let name = kind.file_name();
            let path = folder.join(&name);
            let bytes = match std::fs::read(&path) {
                Ok(bytes) => bytes,
                Err(e) if e.kind() == std::io::ErrorKind::NotFound => {
                    return Err(DataError::Absent { folder: folder.into(), file: name });
                }
                Err(source) => return Err(TableError::Read { path, source }.into()),
            };
            let table = file::decode(&bytes).map_err(|e| e.at(&path))?;
            let checksum = file::checksum(&bytes).unwrap_or_default();
            identities.push(Identity { file: name, title: table.title.clone(), checksum });
            Ok(table)
        };
        let mut view =
            |kind: Kind| -> Result<(Table, PathBuf), DataError> { Ok((read(kind)?, folder.join(kind.file_name()))) };
        macro_rules! load {
            ($view:ident, $kind:ident) => {{
                let (table, path) = view(Kind::$kind)?;
                $view::from_table(&table).map_err(|e| e.at(&path))?
            }};
        }
        Ok(Self {
            standard_atmosphere: load!(StandardAtmosphere, StandardAtmosphere),
            rayleigh: load!(Rayleigh, Rayleigh),
            ozone_cross_section: load!(OzoneCrossSection, OzoneCrossSection),
            ozone_profiles: load!(OzoneProfiles, OzoneProfiles),
            ozone_layers: load!(OzoneLayers, OzoneLayers),
            sun: load!(Sun, Sun),
            observer: load!(Observer, Observer),
            ground_albedo: load!(GroundAlbedo, GroundAlbedo),
            identities,
        })
    }
}
