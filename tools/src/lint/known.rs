//! What Airlight's own tables hold for each biome and layer: the measure of what others say of them.

use tables::views::{AerosolSource, Biome};

/// Particles that have optics of their own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Layer {
    /// The lowest layer of a biome after a source.
    Lowest(AerosolSource, Biome),
    /// OPAC's free troposphere at 50 % humidity.
    FreeTroposphere,
    /// OPAC's stratosphere.
    Stratosphere,
    /// OPAC's transported mineral.
    TransportedMineral,
}

/// Wavelengths of [`Known::extinction_m2`], nm.
pub(super) const WAVELENGTHS_NM: [f64; 3] = [300.0, 550.0, 1000.0];

/// Lowest and highest values over all humidities (0 to 99 %) and, but for the extinction, all wavelengths from 300 to
/// 1000 nm.
#[derive(Debug, Clone, Copy)]
pub(super) struct Known {
    pub(super) layer: Layer,
    /// Extinction cross-section for each particle, m^2, at [`WAVELENGTHS_NM`].
    pub(super) extinction_m2: [(f64, f64); 3],
    /// Single-scattering albedo, 1.
    pub(super) albedo: (f64, f64),
    /// Asymmetry parameter, 1.
    pub(super) asymmetry: (f64, f64),
    /// Number density at the lower end of the layer, m^-3.
    pub(super) density_m3: f64,
}

impl Known {
    /// Lowest and highest extinction cross-section at a wavelength in nm, m^2: linear in the logarithms between
    /// [`WAVELENGTHS_NM`], the last slope goes on outside.
    pub(super) fn extinction(&self, wavelength_nm: f64) -> (f64, f64) {
        let i = usize::from(wavelength_nm > WAVELENGTHS_NM[1]);
        let (a, b) = (WAVELENGTHS_NM[i], WAVELENGTHS_NM[i + 1]);
        let t = (wavelength_nm / a).ln() / (b / a).ln();
        let (low, high) = (self.extinction_m2[i], self.extinction_m2[i + 1]);
        (low.0 * (high.0 / low.0).powf(t), low.1 * (high.1 / low.1).powf(t))
    }
}

/// As the tables of `data/` have them, in three digits; a test compares.
#[rustfmt::skip]
pub(super) const KNOWN: [Known; 21] = [
    Known { layer: Layer::Lowest(AerosolSource::Opac, Biome::Background), extinction_m2: [(5.40e-15, 4.48e-14), (2.57e-15, 2.86e-14), (9.32e-16, 1.34e-14)], albedo: (0.793, 0.991), asymmetry: (0.548, 0.779), density_m3: 7.32e+08 },
    Known { layer: Layer::Lowest(AerosolSource::Opac, Biome::DesertDust), extinction_m2: [(6.16e-14, 1.19e-13), (5.80e-14, 9.57e-14), (5.56e-14, 7.38e-14)], albedo: (0.688, 0.947), asymmetry: (0.693, 0.806), density_m3: 2.30e+09 },
    Known { layer: Layer::Lowest(AerosolSource::Opac, Biome::MaritimeClean), extinction_m2: [(2.05e-14, 3.16e-13), (1.75e-14, 3.00e-13), (1.40e-14, 2.96e-13)], albedo: (0.980, 1.000), asymmetry: (0.676, 0.826), density_m3: 1.52e+09 },
    Known { layer: Layer::Lowest(AerosolSource::Opac, Biome::MaritimeMineral), extinction_m2: [(2.38e-14, 3.80e-13), (2.11e-14, 3.67e-13), (1.73e-14, 3.68e-13)], albedo: (0.983, 1.000), asymmetry: (0.679, 0.828), density_m3: 6.00e+08 },
    Known { layer: Layer::Lowest(AerosolSource::Opac, Biome::PolarAntarctic), extinction_m2: [(1.10e-13, 1.17e-12), (7.30e-14, 1.23e-12), (3.40e-14, 1.03e-12)], albedo: (0.997, 1.000), asymmetry: (0.671, 0.802), density_m3: 4.30e+07 },
    Known { layer: Layer::Lowest(AerosolSource::Opac, Biome::PolarArctic), extinction_m2: [(2.87e-15, 2.08e-14), (1.52e-15, 1.53e-14), (7.54e-16, 1.05e-14)], albedo: (0.715, 0.979), asymmetry: (0.612, 0.791), density_m3: 6.60e+09 },
    Known { layer: Layer::Lowest(AerosolSource::Opac, Biome::RemoteContinental), extinction_m2: [(8.65e-15, 7.45e-14), (4.39e-15, 4.78e-14), (1.89e-15, 2.28e-14)], albedo: (0.857, 0.995), asymmetry: (0.607, 0.780), density_m3: 2.60e+09 },
    Known { layer: Layer::Lowest(AerosolSource::Opac, Biome::Rural), extinction_m2: [(4.61e-15, 3.47e-14), (2.31e-15, 2.22e-14), (9.95e-16, 1.06e-14)], albedo: (0.755, 0.984), asymmetry: (0.600, 0.778), density_m3: 1.53e+10 },
    Known { layer: Layer::Lowest(AerosolSource::Opac, Biome::Urban), extinction_m2: [(2.52e-15, 1.42e-14), (1.23e-15, 8.93e-15), (5.31e-16, 4.24e-15)], albedo: (0.567, 0.954), asymmetry: (0.580, 0.773), density_m3: 1.58e+11 },
    Known { layer: Layer::Lowest(AerosolSource::Jaenicke, Biome::Background), extinction_m2: [(8.78e-13, 8.78e-13), (9.11e-13, 9.11e-13), (9.23e-13, 9.23e-13)], albedo: (1.000, 1.000), asymmetry: (0.750, 0.773), density_m3: 2.52e+08 },
    Known { layer: Layer::Lowest(AerosolSource::Jaenicke, Biome::DesertDust), extinction_m2: [(8.56e-13, 8.56e-13), (8.73e-13, 8.73e-13), (8.91e-13, 8.91e-13)], albedo: (0.564, 0.730), asymmetry: (0.832, 0.927), density_m3: 1.87e+09 },
    Known { layer: Layer::Lowest(AerosolSource::Jaenicke, Biome::MaritimeClean), extinction_m2: [(1.44e-13, 1.44e-13), (1.16e-13, 1.16e-13), (7.94e-14, 7.94e-14)], albedo: (1.000, 1.000), asymmetry: (0.711, 0.747), density_m3: 2.05e+08 },
    Known { layer: Layer::Lowest(AerosolSource::Jaenicke, Biome::MaritimeMineral), extinction_m2: [(1.38e-13, 1.38e-13), (1.29e-13, 1.29e-13), (9.91e-14, 9.91e-14)], albedo: (0.705, 0.785), asymmetry: (0.697, 0.750), density_m3: 2.05e+08 },
    Known { layer: Layer::Lowest(AerosolSource::Jaenicke, Biome::PolarAntarctic), extinction_m2: [(9.30e-14, 9.30e-14), (5.72e-14, 5.72e-14), (3.86e-14, 3.86e-14)], albedo: (0.999, 1.000), asymmetry: (0.701, 0.728), density_m3: 2.39e+07 },
    Known { layer: Layer::Lowest(AerosolSource::Jaenicke, Biome::PolarArctic), extinction_m2: [(9.78e-14, 9.78e-14), (7.06e-14, 7.06e-14), (4.74e-14, 4.74e-14)], albedo: (0.778, 0.817), asymmetry: (0.666, 0.725), density_m3: 2.39e+07 },
    Known { layer: Layer::Lowest(AerosolSource::Jaenicke, Biome::RemoteContinental), extinction_m2: [(1.79e-14, 1.79e-14), (7.25e-15, 7.25e-15), (2.69e-15, 2.69e-15)], albedo: (0.743, 0.949), asymmetry: (0.569, 0.678), density_m3: 6.10e+09 },
    Known { layer: Layer::Lowest(AerosolSource::Jaenicke, Biome::Rural), extinction_m2: [(7.34e-15, 7.34e-15), (4.50e-15, 4.50e-15), (2.86e-15, 2.86e-15)], albedo: (0.787, 0.894), asymmetry: (0.657, 0.694), density_m3: 8.79e+09 },
    Known { layer: Layer::Lowest(AerosolSource::Jaenicke, Biome::Urban), extinction_m2: [(3.56e-15, 3.56e-15), (2.20e-15, 2.20e-15), (1.18e-15, 1.18e-15)], albedo: (0.533, 0.698), asymmetry: (0.587, 0.673), density_m3: 1.37e+11 },
    Known { layer: Layer::FreeTroposphere, extinction_m2: [(8.29e-15, 8.29e-15), (4.04e-15, 4.04e-15), (1.49e-15, 1.49e-15)], albedo: (0.867, 0.940), asymmetry: (0.603, 0.706), density_m3: 5.70e+08 },
    Known { layer: Layer::Stratosphere, extinction_m2: [(1.08e-13, 1.08e-13), (7.12e-14, 7.12e-14), (3.22e-14, 3.22e-14)], albedo: (1.000, 1.000), asymmetry: (0.669, 0.725), density_m3: 3.00e+06 },
    Known { layer: Layer::TransportedMineral, extinction_m2: [(5.51e-12, 5.51e-12), (5.85e-12, 5.85e-12), (6.37e-12, 6.37e-12)], albedo: (0.578, 0.921), asymmetry: (0.714, 0.904), density_m3: 1.00e+07 },
];

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;
    use tables::views::Aerosol;

    /// The numbers are those of the tables: to their last digit, half a unit of which is 0.5 % of the cross-sections
    /// and 5e-4 of the rest.
    #[test]
    fn the_ranges_are_those_of_the_tables() {
        let data = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../data"));
        for known in KNOWN {
            let (source, biome, index) = match known.layer {
                Layer::Lowest(source, biome) => (source, biome, 0),
                Layer::FreeTroposphere => (AerosolSource::Opac, Biome::Urban, 1),
                Layer::Stratosphere => (AerosolSource::Opac, Biome::Urban, 2),
                Layer::TransportedMineral => (AerosolSource::Opac, Biome::MaritimeMineral, 1),
            };
            let table = tables::file::read(&data.join(Aerosol::file_name(source, biome))).expect("a table");
            let name = &Aerosol::from_table(&table).expect("an aerosol").species[index].name;
            let values = |end: &str| {
                let name = format!("{name}{end}");
                &table.fields.iter().find(|f| f.name == name).expect("a field").values
            };
            let range = |values: &[f64]| {
                (values.iter().copied().fold(f64::INFINITY, f64::min), values.iter().copied().fold(0.0, f64::max))
            };
            let near = |a: (f64, f64), b: (f64, f64), relative: f64, absolute: f64| {
                let close = |x: f64, y: f64| (x - y).abs() <= relative * y.abs() + absolute;
                assert!(close(a.0, b.0) && close(a.1, b.1), "{:?}: {a:?} is not {b:?}", known.layer);
            };
            let (extinction, scattering) = (values("_extinction"), values("_scattering"));
            let nodes = &table.axis("wavelength").expect("an axis").nodes;
            for (nm, stated) in WAVELENGTHS_NM.into_iter().zip(known.extinction_m2) {
                let at = nodes.iter().position(|node| *node == nm).expect("a node");
                let there: Vec<f64> = extinction.iter().skip(at).step_by(nodes.len()).copied().collect();
                near(stated, range(&there), 5.1e-3, 0.0);
            }
            let albedo: Vec<f64> = scattering.iter().zip(extinction).map(|(s, e)| s / e).collect();
            near(known.albedo, range(&albedo), 0.0, 5.1e-4);
            near(known.asymmetry, range(values("_asymmetry")), 0.0, 5.1e-4);
            let density = values("_number_density")[0];
            near((known.density_m3, known.density_m3), (density, density), 5.1e-3, 0.0);
        }
    }
}
