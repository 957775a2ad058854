//! The tables of `data/`, read once: from a folder, or those that the program carries.

use crate::carried::carried;
use std::path::{Path, PathBuf};
use tables::file::{checksum, decode};
use tables::views::{
    Aerosol, AerosolSource, Biome, GroundAlbedo, Observer, Origin, OzoneCrossSection, OzoneLayers, OzoneProfiles,
    Rayleigh, StandardAtmosphere, Sun,
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
    /// An aerosol that is somebody's own.
    pub own_aerosol: Option<Aerosol>,
    /// What was read, for the picture's attributes.
    pub identities: Vec<Identity>,
    source: Source,
}

/// Where tables come from.
#[derive(Debug, Clone)]
enum Source {
    /// A folder of somebody's own.
    Folder(PathBuf),
    /// The program itself.
    Carried,
}

impl Source {
    /// The path of a table, for errors.
    fn path(&self, file: &str) -> PathBuf {
        match self {
            Self::Folder(folder) => folder.join(file),
            Self::Carried => file.into(),
        }
    }

    /// Reads one file through its view.
    fn table<V>(&self, file: String, view: fn(&Table) -> Result<V, TableError>) -> Result<(V, Identity), DataError> {
        let path = self.path(&file);
        let (table, identity) = match self {
            Self::Folder(folder) => match read(&path) {
                Err(DataError::Table(TableError::Read { source, .. }))
                    if source.kind() == std::io::ErrorKind::NotFound =>
                {
                    return Err(DataError::Absent { folder: folder.clone(), file });
                }
                other => other?,
            },
            Self::Carried => match carried(&file) {
                Some(bytes) => decoded(&path, bytes)?,
                None => return Err(DataError::NotCarried { file }),
            },
        };
        let seen = view(&table).map_err(|error| error.at(&path))?;
        Ok((seen, identity))
    }
}

/// What identifies a table file that was read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Identity {
    /// File name below the data folder; of an own table the name of the file alone.
    pub file: String,
    /// What the table holds.
    pub kind: Kind,
    /// Whether it is an own table, which came in place of that of the data folder or beside it.
    pub own: bool,
    /// Title in the file.
    pub title: String,
    /// [`checksum`] of the file.
    pub checksum: u32,
}

/// Why the tables of a folder cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum DataError {
    /// A table is not there.
    #[error("no table {file} in {}: run `airlight-tools build`, or leave --data out for the tables that the program carries", folder.display())]
    Absent {
        /// The folder looked in.
        folder: PathBuf,
        /// The file missed.
        file: String,
    },
    /// A table that the program does not carry.
    #[error("the program carries no table {file}: name a folder that has it with --data")]
    NotCarried {
        /// The file missed.
        file: String,
    },
    /// Two own tables of a kind of which a picture has one.
    #[error("{} and {} are both of the kind {kind}: a picture takes one", first, second.display())]
    Twice {
        /// The kind.
        kind: Kind,
        /// File name of the first.
        first: String,
        /// The second.
        second: PathBuf,
    },
    /// A ground of an own table whose name is taken.
    #[error("{}: there is a ground called {name:?} already: give it another name", path.display())]
    GroundTwice {
        /// The table.
        path: PathBuf,
        /// The name.
        name: String,
    },
    /// A table is there and cannot be used.
    #[error(transparent)]
    Table(#[from] TableError),
}

impl Data {
    /// The same with the sun at another distance than 1 au.
    #[must_use]
    pub fn with_sun_at(&self, distance_au: f64) -> Self {
        Self { sun: self.sun.at_distance(distance_au), ..self.clone() }
    }

    /// Reads every kind of table from `folder`; aerosols when they are asked for.
    ///
    /// # Errors
    /// [`DataError`] with the first file that is absent or cannot be used, and why.
    pub fn load(folder: &Path) -> Result<Self, DataError> {
        Self::from_source(Source::Folder(folder.into()))
    }

    /// The tables that the program carries: those of `data/` when it was built.
    ///
    /// # Errors
    /// As [`Data::load`]: none, if the program was built from whole tables, as a test sees to.
    pub fn carried() -> Result<Self, DataError> {
        Self::from_source(Source::Carried)
    }

    fn from_source(source: Source) -> Result<Self, DataError> {
        let mut identities = Vec::new();
        macro_rules! load {
            ($view:ident) => {{
                let (view, identity) = source.table(Kind::$view.file_name(), $view::from_table)?;
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
            own_aerosol: None,
            identities,
            source,
        })
    }

    /// Reads the aerosol of a biome after a source.
    ///
    /// # Errors
    /// [`DataError`] if its file is absent, cannot be used, or holds another biome or source.
    pub fn aerosol(&self, source: AerosolSource, biome: Biome) -> Result<(Aerosol, Identity), DataError> {
        let name = Aerosol::file_name(source, biome);
        let (aerosol, identity) = self.source.table(name, Aerosol::from_table)?;
        if aerosol.origin != Origin::Biome(source, biome) {
            let text = format!("the table holds {}", aerosol.origin);
            return Err(TableError::Inconsistent(text).at(&self.source.path(&identity.file)).into());
        }
        Ok((aerosol, identity))
    }
}

impl Data {
    /// The same tables with some of one's own, by their paths: each replaces the one of its kind; the spectra of
    /// grounds are added.
    ///
    /// # Errors
    /// [`DataError`] with the first file that is absent or cannot be used, of a kind that was given before, or with a
    /// ground whose name is taken.
    pub fn with_tables(&self, paths: &[String]) -> Result<Self, DataError> {
        let mut data = self.clone();
        for path in paths {
            data.take(Path::new(path))?;
        }
        Ok(data)
    }

    /// The own tables.
    pub fn own(&self) -> impl Iterator<Item = &Identity> {
        self.identities.iter().filter(|identity| identity.own)
    }

    fn take(&mut self, path: &Path) -> Result<(), DataError> {
        let (table, mut identity) = read(path)?;
        identity.own = true;
        let (kind, named) = (table.kind, |error: TableError| error.at(path));
        let adds = kind == Kind::GroundAlbedo;
        if let Some(first) = self.own().find(|first| first.kind == kind && !adds) {
            return Err(DataError::Twice { kind, first: first.file.clone(), second: path.into() });
        }
        match kind {
            Kind::StandardAtmosphere => {
                self.standard_atmosphere = StandardAtmosphere::from_table(&table).map_err(named)?;
            }
            Kind::Rayleigh => self.rayleigh = Rayleigh::from_table(&table).map_err(named)?,
            Kind::OzoneCrossSection => {
                self.ozone_cross_section = OzoneCrossSection::from_table(&table).map_err(named)?;
            }
            Kind::OzoneProfiles => self.ozone_profiles = OzoneProfiles::from_table(&table).map_err(named)?,
            Kind::OzoneLayers => self.ozone_layers = OzoneLayers::from_table(&table).map_err(named)?,
            Kind::Sun => self.sun = Sun::from_table(&table).map_err(named)?,
            Kind::Observer => self.observer = Observer::from_table(&table).map_err(named)?,
            Kind::Aerosol => self.own_aerosol = Some(Aerosol::from_table(&table).map_err(named)?),
            Kind::SolvedSky => {
                let text = "a solved sky is taken from its folder by --keep-tables";
                return Err(named(TableError::Inconsistent(text.into())).into());
            }
            Kind::GroundAlbedo => {
                for (name, spectrum) in GroundAlbedo::from_table(&table).map_err(named)?.spectra {
                    if self.ground_albedo.spectra.contains_key(&name) {
                        return Err(DataError::GroundTwice { path: path.into(), name });
                    }
                    self.ground_albedo.spectra.insert(name, spectrum);
                }
            }
        }
        if !adds {
            self.identities.retain(|other| other.kind != kind);
        }
        self.identities.push(identity);
        Ok(())
    }
}

/// Reads one file. Only the table is left of it when this returns.
fn read(path: &Path) -> Result<(Table, Identity), DataError> {
    let bytes = std::fs::read(path).map_err(|source| TableError::Read { path: path.into(), source })?;
    decoded(path, &bytes)
}

/// The table in the bytes of a file.
fn decoded(path: &Path, bytes: &[u8]) -> Result<(Table, Identity), DataError> {
    let table = decode(bytes).map_err(|error| error.at(path))?;
    let identity = Identity {
        file: path.file_name().unwrap_or_default().to_string_lossy().into_owned(),
        kind: table.kind,
        own: false,
        title: table.title.clone(),
        // A file that decodes has a checksum.
        checksum: checksum(bytes).unwrap_or_default(),
    };
    Ok((table, identity))
}
