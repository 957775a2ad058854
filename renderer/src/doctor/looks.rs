//! A few quick looks at a scene.

use crate::data::Data;
use crate::plan::{Candidate, Costs, Evidence, Measured, Spectrum, Traits, Transfer, outside};
use crate::render::{RenderError, Sky};
use crate::sampling::Sampler;
use crate::scene::{Albedo, Scene, horizon_dip};
use crate::spectrum::{Scheme, Wavelengths};
use crate::transport::rungs::Rung;
use crate::transport::{Fineness, Method};
use tables::units::KM;

/// Looks along a picture's width and height.
const ACROSS: u32 = 12;

/// Wavelengths of a look.
const WAVELENGTHS: usize = 8;

/// Reflectance of a ground that is a map, for looks.
const GREY: f64 = 0.2;

/// Wavelengths whose costs were measured, that is one packet.
const PACKET: usize = 16;

/// What is seen of a scene before it is rendered.
#[derive(Debug, Clone, PartialEq)]
pub struct Looks {
    /// Luminances in cd/m^2 in directions all over the picture, the sun's disc left out.
    pub luminances: Vec<f64>,
    /// How many of them end on the ground.
    pub to_ground: usize,
    /// Predicted core-seconds of the picture, and the error it then has (a share, of noise or of its tables); or in what the scene lies outside the stored
    /// measurements.
    pub cost: Result<Cost, String>,
}

/// What a picture is predicted to take.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cost {
    /// Core-seconds for what is made once.
    pub once_s: f64,
    /// Core-seconds for the picture.
    pub picture_s: f64,
    /// Relative spread of one path's luminance: n samples leave a noise of it over sqrt(n).
    pub spread: f64,
}

impl Looks {
    /// Looks at a valid scene in 12 x 12 directions over its picture: by a coarse solved table of eight wavelengths without polarisation (single scattering
    /// between planes), over a grey ground of 0.2 where the scene has the map of the Earth; costs by the measurements that the program carries
    /// ([`Evidence`]), times the packets of sixteen wavelengths.
    ///
    /// # Errors
    /// [`RenderError`] if the scene itself cannot be rendered, by its method either.
    pub fn take(scene: &Scene, data: &Data) -> Result<Self, RenderError> {
        let quick = Scene {
            method: if scene.flat { Method::Single } else { Method::Solved },
            fineness: (!scene.flat).then_some(Fineness::Coarse),
            wavelengths_nm: Wavelengths::visible(WAVELENGTHS).unwrap_or_default(),
            colour: Scheme::Spectral,
            albedo: if scene.has_texture() { Albedo::Grey(GREY) } else { scene.albedo.clone() },
            polarisation: false,
            filter_deg: None,
            follow_polarisation: Some(false),
            orders: None,
            steps: None,
            sky_type: None,
            spp: None,
            error: None,
            block: None,
            width: Some(ACROSS),
            height: Some(ACROSS),
            ..scene.clone()
        };
        let sky = Sky::new(&quick, data)?;
        // Methods of a smaller range say themselves what they do not cover, and take no time to do so.
        let exact = scene.method == Method::Solved || scene.method.estimator().is_some();
        if !exact {
            Sky::new(scene, data)?;
        }
        let (camera, (width, height)) = (scene.camera(), scene.size());
        let at = |i: u32, side: u32| (f64::from(i) + 0.5) / f64::from(ACROSS) * f64::from(side);
        let horizon = -horizon_dip(scene.altitude_km * KM).sin();
        let mut factors = vec![0.0; sky.wavelengths()];
        let (mut luminances, mut to_ground) = (Vec::new(), 0);
        for (x, y) in (0..ACROSS).flat_map(|y| (0..ACROSS).map(move |x| (x, y))) {
            let Some(direction) = camera.direction(at(x, width), at(y, height)) else { continue };
            to_ground += usize::from(direction.z < horizon);
            sky.radiance(direction, &Sampler::new(0, 0, 0), &mut factors);
            // Where next to nothing is left a coarse table may be below 0.
            luminances.push(sky.colour().xyz(&factors)[1].max(0.0));
        }
        Ok(Self { luminances, to_ground, cost: cost(scene, &Traits::of(scene, &sky)) })
    }

    /// Mean luminance in cd/m^2; 0 of none.
    #[must_use]
    pub fn mean(&self) -> f64 {
        self.luminances.iter().sum::<f64>() / self.luminances.len().max(1) as f64
    }
}

/// By the stored measurements.
fn cost(scene: &Scene, traits: &Traits) -> Result<Cost, String> {
    let seen = Scene { wavelengths_nm: Wavelengths::default(), colour: Scheme::Spectral, ..scene.clone() };
    if let Some(what) = outside(&seen, traits) {
        return Err(what);
    }
    let exact = scene.method == Method::Solved || scene.method == Method::Paths;
    if !exact {
        return Err(format!("the method {}", Rung::of(scene.method).name));
    }
    let prediction = Evidence::new(&Measured::stored()?)?.predict(traits);
    let (width, height) = scene.size();
    let pixels = f64::from(width) * f64::from(height);
    let packets = scene.wavelengths().nm().len().div_ceil(PACKET) as f64;
    let [path_s, spread] = prediction.costs.path;
    let [once_s, picture_s] = if scene.method == Method::Paths {
        [0.0, path_s * pixels * samples(scene, spread)]
    } else {
        of_tables(&prediction.costs, scene, pixels)
    };
    Ok(Cost { once_s: packets * once_s, picture_s: packets * picture_s, spread })
}

/// Samples of each pixel: as many as are asked for, or as the error needs.
pub(super) fn samples(scene: &Scene, spread: f64) -> f64 {
    let needed = scene.error.map(|error| (spread / error).powi(2));
    let most = scene.spp.map(f64::from);
    match (needed, most) {
        (Some(needed), Some(most)) => needed.min(most),
        (Some(one), None) | (None, Some(one)) => one,
        (None, None) => f64::from(scene.default_spp()),
    }
}

/// Of tables that state their error, so that a coarser one is solved too; and of so many looks at each pixel.
fn of_tables(costs: &Costs, scene: &Scene, pixels: f64) -> [f64; 2] {
    let polarised = scene.polarised().unwrap_or(true);
    let of = |fineness: Fineness| {
        let transfer = Transfer { fineness: Some(fineness), polarised };
        costs.of(Candidate { transfer, spectrum: Spectrum::Even16 }, pixels)
    };
    // The finest was not measured: as the fine one, at least.
    let known = |fineness: Fineness| if fineness == Fineness::Finest { Fineness::Fine } else { fineness };
    let [once, picture] = of(scene.fineness.map_or(Fineness::Usual, known));
    let coarser = if scene.fineness.is_none() { of(Fineness::Coarse)[0] } else { 0.0 };
    [once + coarser, picture * f64::from(scene.spp.unwrap_or(1))]
}
