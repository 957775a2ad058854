//! The written tables of a folder, read through their views.

use std::path::Path;
use tables::views::{Aerosol, AerosolSource, Biome};
use tables::{Kind, Table, TableError, views};

/// A folder of tables, such as `data/`. Each method reads one file, through the view of its kind.
#[derive(Debug, Clone, Copy)]
pub struct Data<'a>(pub &'a Path);

impl Data<'_> {
    fn read<V>(self, file: &str, view: fn(&Table) -> Result<V, TableError>) -> Result<V, TableError> {
        let path = self.0.join(file);
        view(&tables::file::read(&path)?).map_err(|e| e.at(&path))
    }

    /// The standard atmosphere.
    ///
    /// # Errors
    /// [`TableError`], with the path, if the file cannot be used.
    pub fn air(self) -> Result<views::StandardAtmosphere, TableError> {
        self.read(&Kind::StandardAtmosphere.file_name(), views::StandardAtmosphere::from_table)
    }

    /// Rayleigh scattering.
    ///
    /// # Errors
    /// As [`Data::air`].
    pub fn rayleigh(self) -> Result<views::Rayleigh, TableError> {
        self.read(&Kind::Rayleigh.file_name(), views::Rayleigh::from_table)
    }

    /// How ozone absorbs.
    ///
    /// # Errors
    /// As [`Data::air`].
    pub fn ozone_cross_section(self) -> Result<views::OzoneCrossSection, TableError> {
        self.read(&Kind::OzoneCrossSection.file_name(), views::OzoneCrossSection::from_table)
    }

    /// Ozone by month and latitude.
    ///
    /// # Errors
    /// As [`Data::air`].
    pub fn ozone_profiles(self) -> Result<views::OzoneProfiles, TableError> {
        self.read(&Kind::OzoneProfiles.file_name(), views::OzoneProfiles::from_table)
    }

    /// The sun.
    ///
    /// # Errors
    /// As [`Data::air`].
    pub fn sun(self) -> Result<views::Sun, TableError> {
        self.read(&Kind::Sun.file_name(), views::Sun::from_table)
    }

    /// The aerosol of a biome after a source.
    ///
    /// # Errors
    /// As [`Data::air`].
    pub fn aerosol(self, source: AerosolSource, biome: Biome) -> Result<Aerosol, TableError> {
        self.read(&Aerosol::file_name(source, biome), Aerosol::from_table)
    }
}
