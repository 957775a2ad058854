//! The tables of `data/`, read once.

use std::path::{Path, PathBuf};
use tables::file::{checksum, decode};
use tables::views::{
    Aerosol, AerosolSource, Biome, GroundAlbedo, Observer, OzoneCrossSection, OzoneLayers, OzoneProfiles, Rayleigh,
    StandardAtmosphere, Sun,
};
use tables::{Kind, Table, TableError};

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
    folder: PathBuf,
}

/// What identifies a table file that was read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Identity {
    /// File name below the data folder.
    pub file: String,
    /// Title in the file.
    pub title: String,
    /// [`checksum`] of the file.
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
    /// Reads every kind of table from `folder`; aerosols when they are asked for.
    ///
    /// # Errors
    /// [`DataError`] with the first file that is absent or cannot be used, and why.
    pub fn load(folder: &Path) -> Result<Self, DataError> {
        let mut identities = Vec::new();
        macro_rules! load {
            ($view:ident) => {{
                let (view, identity) = read(folder, Kind::$view.file_name(), $view::from_table)?;
                identities.push(identity);
                view
            }};
        }
        Ok(Self {
            standard_atmosphere: load!(StandardAtmosphere),
            rayleigh: load!(Rayleigh),
            ozone_cross_section: load!(OzoneCrossSection),
            ozone_profiles: load!(OzoneProfiles),
            ozone_layers: load!(OzoneLayers),
            sun: load!(Sun),
            observer: load!(Observer),
            ground_albedo: load!(GroundAlbedo),
            identities,
            folder: folder.into(),
        })
    }

    /// Reads the aerosol of a biome after a source.
    ///
    /// # Errors
    /// [`DataError`] if its file is absent, cannot be used, or holds another biome or source.
    pub fn aerosol(&self, source: AerosolSource, biome: Biome) -> Result<(Aerosol, Identity), DataError> {
        let name = Aerosol::file_name(source, biome);
        let (aerosol, identity) = read(&self.folder, name, Aerosol::from_table)?;
        if (aerosol.source, aerosol.biome) != (source, biome) {
            let text = format!("the table holds {} after {}", aerosol.biome, aerosol.source);
            return Err(TableError::Inconsistent(text).at(&self.folder.join(&identity.file)).into());
        }
        Ok((aerosol, identity))
    }
}

/// Reads one file through its view.
fn read<V>(folder: &Path, file: String, view: fn(&Table) -> Result<V, TableError>) -> Result<(V, Identity), DataError> {
    let path = folder.join(&file);
    let bytes = match std::fs::read(&path) {
        Ok(bytes) => bytes,
        Err(e) if e.kind() == std::io::ErrorKind::NotFound => {
            return Err(DataError::Absent { folder: folder.into(), file });
        }
        Err(source) => return Err(TableError::Read { path, source }.into()),
    };
    let named = |error: TableError| error.at(&path);
    let table = decode(&bytes).map_err(named)?;
    // A file that decodes has a checksum.
    let checksum = checksum(&bytes).unwrap_or_default();
    // Now that the table is read the file need not stay in memory while the view is made.
    drop(bytes);
    let seen = view(&table).map_err(named)?;
    Ok((seen, Identity { file, title: table.title, checksum }))
}
