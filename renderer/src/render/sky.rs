//! A scene turned into something that answers: what arrives from a direction?

use super::RenderError;
use super::carrier::{Carrier, Parts, Wanted};
use super::certify::{Certifies, spread};
use super::{domes, left_out};
use crate::atmosphere::{Air, AirSettings, Haze, OzoneSource};
use crate::data::{Data, Identity};
use crate::geometry::{Place, Shape};
use crate::polarisation::{Frame, Stokes};
use crate::sampling::Sampler;
use crate::scene::{Scene, SceneError};
use crate::spectrum::Colour;
use crate::transport::highest;
use crate::transport::rungs::{Conditions, Dome, Rung, Stated};
use glam::DVec3;
use std::fmt::Debug;
use std::ops::Range;
use std::path::Path;
use tables::units::{EARTH_RADIUS_M, KM};
use tables::views::Observer;
use tables::{Curve, Kind, TableError};

/// Everything that is computed once for a picture. All spectra are per unit of the
/// sun's spectral irradiance above the atmosphere, in the order of the scene's wavelengths.
#[derive(Debug)]
pub struct Sky {
    carriers: Vec<(Range<usize>, Box<dyn Carrier>)>,
    place: Place,
    colour: Colour,
    irradiance_w_m2_nm: Vec<f64>,
    albedo: Vec<f64>,
    air: Air,
    any_place: bool,
    sun_direction: DVec3,
    identities: Vec<Identity>,
    shows: Shows,
    polarised: bool,
    fitted: Option<Fitted>,
    turbidity: f64,
    observer: Observer,
}

/// A fitted sky in the place of Airlight's; the sun behind the air is Airlight's own.
#[derive(Debug)]
struct Fitted {
    dome: Box<dyn Dome>,
    /// Of the wavelengths in which the sun is seen.
    colour: Colour,
}

/// What a picture shows of the light.
#[derive(Debug, Clone, Copy)]
pub(super) enum Shows {
    /// Radiance.
    Radiance,
    /// Stokes parameters.
    Stokes,
    /// Radiance behind a polarising filter at this angle in radians.
    Filtered(f64),
}

impl Sky {
    /// Prepares the atmosphere, the ground and the sun of a valid scene.
    ///
    /// # Errors
    /// [`RenderError`] if the scene names what the data do not have, or a table does not reach.
    pub fn new(scene: &Scene, data: &Data) -> Result<Self, RenderError> {
        Self::kept(scene, data, None)
    }

    /// As [`Sky::new`], with solved tables taken from the folder `kept` where they are there, and written to it where not.
    ///
    /// # Errors
    /// As [`Sky::new`], and if a table there cannot be read or written.
    pub fn kept(scene: &Scene, data: &Data, kept: Option<&Path>) -> Result<Self, RenderError> {
        let with_own;
        let data = if scene.tables.is_empty() {
            data
        } else {
            with_own = data.with_tables(&scene.tables)?;
            &with_own
        };
        let elsewhere;
        let data = if scene.sun_distance_au == 1.0 {
            data
        } else {
            elsewhere = data.with_sun_at(scene.sun_distance_au);
            &elsewhere
        };
        check_own(scene, data)?;
        check_wavelengths(scene, data)?;
        let wavelengths = &scene.wavelengths();
        let albedo = scene.albedo_spectrum(data)?;
        let air = Air::new(
            data,
            &AirSettings {
                month: scene.month,
                latitude_deg: scene.latitude_deg,
                ozone_source: scene.ozone_source,
                ozone_du: scene.ozone_du,
                top_m: scene.top_km * KM,
                depolarisation: scene.depolarisation,
            },
        )?;
        let mut identities = data.identities.clone();
        let aerosol = match scene.biome {
            None => data.own_aerosol.clone(),
            Some(biome) => {
                let (aerosol, identity) = data.aerosol(scene.aerosol_source, biome)?;
                identities.push(identity);
                Some(aerosol)
            }
        };
        let molecular = air.ground_extinction()?;
        let haze = aerosol.map(|aerosol| Haze::new(aerosol, scene.haze(), molecular)).transpose()?;
        let air = air.with_haze(haze);
        let sun_direction = scene.sun_direction();
        let place = Place::above(scene.altitude_km * KM);
        let polarised = scene.polarised().unwrap_or_else(|| left_out::is_followed(scene, &air, &albedo));
        let turbidity = 1.0 + air.haze().map_or(0.0, Haze::optical_depth) / air.molecular_depth()?;
        Rung::of(scene.method).covers(&conditions(scene, turbidity, polarised))?;
        let wanted = &looked_at(scene);
        let parts = Parts {
            wavelengths,
            albedo: &albedo,
            air: &air,
            data,
            place,
            sun_direction,
            wanted,
            scene,
            polarised,
            kept,
        };
        let carriers = wavelengths.packets().into_iter().map(|packet| {
            let carrier = match packet.lanes {
                1 => parts.carry::<1>(&packet),
                8 => parts.carry::<8>(&packet),
                _ => parts.carry::<16>(&packet),
            };
            carrier.map(|carrier| (packet.range, carrier))
        });
        let carriers = carriers.collect::<Result<_, _>>()?;
        let irradiance = wavelengths.nm().iter().map(|&nm| data.sun.irradiance_w_m2_nm.at(nm));
        let mut irradiance_w_m2_nm: Vec<f64> = irradiance.collect::<Result<_, _>>()?;
        let mut colour = scene.colour.colour(&data.sun, &data.observer, &data.ozone_cross_section, wavelengths)?;
        let fitted = if scene.method.is_dome() {
            let dome = domes::dome(scene, data, &air, turbidity)?;
            irradiance_w_m2_nm = vec![1.0; 3];
            Some(Fitted { dome, colour: std::mem::replace(&mut colour, Colour::direct()) })
        } else {
            None
        };
        Ok(Self {
            carriers,
            place,
            colour,
            irradiance_w_m2_nm,
            any_place: data.ozone_profiles.is_single() && scene.ozone_source == OzoneSource::McPetersLabow,
            albedo,
            air,
            sun_direction,
            identities,
            shows: match scene.filter_deg {
                Some(angle) => Shows::Filtered(angle.to_radians()),
                None if scene.polarisation => Shows::Stokes,
                None => Shows::Radiance,
            },
            polarised,
            fitted,
            turbidity,
            observer: data.observer.clone(),
        })
    }

    /// Turns to the sun, the observer and the camera of another scene that has the same air and ground; solved tables stay, whatever
    /// error that scene asks for.
    ///
    /// # Errors
    /// [`RenderError::Solve`] if the tables are too far off there; then it is of neither scene. [`SceneError::Refused`] of a fitted
    /// sky, which belongs to one sun.
    pub fn turn(&mut self, scene: &Scene) -> Result<(), RenderError> {
        if self.fitted.is_some() {
            return Err(SceneError::Refused("a fitted sky belongs to one sun".into()).into());
        }
        Rung::of(scene.method).covers(&conditions(scene, self.turbidity, self.polarised))?;
        let wanted = looked_at(scene);
        (self.place, self.sun_direction) = (Place::above(scene.altitude_km * KM), scene.sun_direction());
        for (_, carrier) in &mut self.carriers {
            carrier.turn(self.place, self.sun_direction, &wanted)?;
        }
        Ok(())
    }

    /// One unbiased estimate of the radiance factors (sr^-1; X, Y and Z in cd/m^2 of a fitted sky) that arrive at the observer out of
    /// `direction`, without the solar disc. The stream is that of one sample: every packet of
    /// wavelengths begins with the same numbers, so that their paths, and their noise, are alike.
    pub fn radiance(&self, direction: DVec3, sampler: &Sampler, factors: &mut [f64]) {
        if let Some(fitted) = &self.fitted {
            factors.copy_from_slice(&fitted.dome.xyz(direction));
            return;
        }
        for (range, carrier) in &self.carriers {
            carrier.radiance(self.place, direction, &mut sampler.clone(), &mut factors[range.clone()]);
        }
    }

    /// As [`Sky::radiance`], what a picture keeps of it, in sr^-1: radiance factors, behind the filter if there is one; or the
    /// Stokes parameters, I at all wavelengths, then Q, then U. `level` is e1, made perpendicular to `direction` if it is not
    /// quite; e2 is upwards from it.
    pub fn look(&self, direction: DVec3, level: DVec3, sampler: &Sampler, values: &mut [f64]) {
        let count = self.wavelengths();
        match self.shows {
            Shows::Radiance => self.radiance(direction, sampler, values),
            Shows::Stokes => self.stokes(direction, level, sampler, &mut |index, Stokes { i, q, u }| {
                (values[index], values[count + index], values[2 * count + index]) = (i, q, u);
            }),
            Shows::Filtered(angle) => self.stokes(direction, level, sampler, &mut |index, seen| {
                values[index] = seen.through(angle);
            }),
        }
    }

    /// Hands the Stokes parameters of each wavelength to `see`. With e2 upwards e1 x e2 = -d: a picture's frame, in
    /// which angles run anticlockwise as one looks, is the mirror image of that of [`crate::polarisation`].
    fn stokes(&self, direction: DVec3, level: DVec3, sampler: &Sampler, see: &mut dyn FnMut(usize, Stokes)) {
        let across = level.reject_from_normalized(direction).try_normalize();
        let frame = Frame::new(direction, -across.unwrap_or_else(|| direction.any_orthonormal_vector()));
        for (range, carrier) in &self.carriers {
            carrier.stokes(self.place, direction, frame, &mut sampler.clone(), &mut |lane, seen: Stokes| {
                see(range.start + lane, seen.mirrored());
            });
        }
    }

    /// Numbers that [`Sky::look`] gives: one for each wavelength, or three.
    #[must_use]
    pub fn values(&self) -> usize {
        self.wavelengths() * if self.keeps_stokes() { 3 } else { 1 }
    }

    /// Whether pictures keep Stokes parameters.
    #[must_use]
    pub fn keeps_stokes(&self) -> bool {
        matches!(self.shows, Shows::Stokes)
    }

    /// Share of natural light that the camera's filter lets pass, 1 without one.
    #[must_use]
    pub fn passes(&self) -> f64 {
        if matches!(self.shows, Shows::Filtered(_)) { 0.5 } else { 1.0 }
    }

    /// The scene that this is the sky of, with what was decided where it does not say: whether light is followed with its polarisation.
    #[must_use]
    pub fn decided(&self, scene: Scene) -> Scene {
        let open = scene.polarised().is_none() && left_out::can_follow(&scene);
        let decided = if open { Some(self.polarised) } else { scene.follow_polarisation };
        Scene { follow_polarisation: decided, ..scene }
    }

    /// Whether light is followed with its polarisation.
    #[must_use]
    pub fn is_polarised(&self) -> bool {
        self.polarised
    }

    /// Whether radiances come from solved tables, without noise.
    #[must_use]
    pub fn is_solved(&self) -> bool {
        !self.carriers.is_empty() && self.carriers.iter().all(|(_, carrier)| carrier.is_solved())
    }

    /// Whether equal directions give equal radiances.
    #[must_use]
    pub fn is_noiseless(&self) -> bool {
        self.fitted.is_some() || self.carriers.iter().all(|(_, carrier)| carrier.is_noiseless())
    }

    /// Bytes of the tables that pictures are made from; 0 of a method without any.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.carriers.iter().map(|(_, carrier)| carrier.bytes()).sum()
    }

    /// Relative error of the solved tables as they state it themselves; `None` if there are none, or of a grid that was chosen.
    #[must_use]
    pub fn table_error(&self) -> Option<f64> {
        let errors = self.carriers.iter().map(|(_, carrier)| carrier.table_error());
        errors.reduce(|a, b| Some(a?.max(b?))).flatten()
    }

    /// What single scattering and its closure state of their own errors, the largest of the packets of wavelengths; `None` of other methods.
    #[must_use]
    pub fn stated(&self) -> Option<Stated> {
        let all = self.carriers.iter().filter_map(|(_, carrier)| carrier.stated(self.place));
        all.reduce(|a, b| Stated { further: a.further.max(b.further), points: a.points.max(b.points) })
    }

    /// Certificates of the solved tables, packet by packet; `None` if there are none.
    pub(super) fn certificates(&self) -> Option<Vec<Box<dyn Certifies + '_>>> {
        self.carriers.iter().map(|(range, carrier)| carrier.certificate(self.place, self.shows, range.len())).collect()
    }

    /// Adds the solar disc seen in `direction` through the air, in sr^-1, times `weight`.
    /// False, with nothing added, off the disc.
    pub fn add_disc(&self, direction: DVec3, weight: f64, factors: &mut [f64]) -> bool {
        self.seen_through_air(factors, |factors| {
            let mut carriers = self.carriers.iter();
            carriers
                .all(|(range, carrier)| carrier.add_disc(self.place, direction, weight, &mut factors[range.clone()]))
        })
    }

    /// Hands `add` the factors of all wavelengths; of a fitted sky what it adds to them goes to X, Y and Z.
    fn seen_through_air<T>(&self, factors: &mut [f64], add: impl FnOnce(&mut [f64]) -> T) -> T {
        let Some(fitted) = &self.fitted else { return add(factors) };
        let mut spectral = vec![0.0; self.carriers.last().map_or(0, |(range, _)| range.end)];
        let result = add(&mut spectral);
        factors.iter_mut().zip(fitted.colour.xyz(&spectral)).for_each(|(factor, value)| *factor += value);
        result
    }

    /// Irradiance of a level surface at the observer by direct sunlight, per unit solar irradiance:
    /// the mean over the disc of limb darkening, transmittance and the cosine where it is
    /// positive, by the midpoint rule in 64 rings and 16 sectors. The rings are even in mu =
    /// sqrt(1 - u), in which the darkening is a polynomial (in u it has a root at the limb): 3e-5.
    #[must_use]
    pub fn direct_irradiance(&self) -> Vec<f64> {
        self.direct_irradiance_of(self.place.up)
    }

    /// As [`Sky::direct_irradiance`], of a surface at the observer with that unit normal; [`Sky::sun_direction`] of one that faces the sun.
    #[must_use]
    pub fn direct_irradiance_of(&self, normal: DVec3) -> Vec<f64> {
        const RINGS: u32 = 64;
        const SECTORS: u32 = 16;
        let mut factors = vec![0.0; self.wavelengths()];
        self.seen_through_air(&mut factors, |factors| {
            for ring in 0..RINGS {
                let mu = (f64::from(ring) + 0.5) / f64::from(RINGS);
                let weight = 2.0 * mu / f64::from(RINGS * SECTORS);
                for sector in 0..SECTORS {
                    let u = [1.0 - mu * mu, (f64::from(sector) + 0.5) / f64::from(SECTORS)];
                    for (range, carrier) in &self.carriers {
                        carrier.add_direct(self.place, normal, u, weight, &mut factors[range.clone()]);
                    }
                }
            }
        });
        factors
    }

    /// What colour radiance factors have.
    #[must_use]
    pub fn colour(&self) -> &Colour {
        &self.colour
    }

    /// Colour of the sun above the air: XYZ of a radiance factor of 1.
    #[must_use]
    pub fn sun_white(&self) -> [f64; 3] {
        self.fitted.as_ref().map_or(&self.colour, |fitted| &fitted.colour).white()
    }

    /// The eye that colours are of.
    #[must_use]
    pub fn observer(&self) -> &Observer {
        &self.observer
    }

    /// The sun's spectral irradiance above the atmosphere in W m^-2 nm^-1; ones of a fitted sky.
    #[must_use]
    pub fn irradiance_w_m2_nm(&self) -> &[f64] {
        &self.irradiance_w_m2_nm
    }

    /// Albedo of the ground at each wavelength.
    #[must_use]
    pub fn albedo(&self) -> &[f64] {
        &self.albedo
    }

    /// Number of wavelengths; 3 of a fitted sky, which has X, Y and Z instead.
    #[must_use]
    pub fn wavelengths(&self) -> usize {
        self.irradiance_w_m2_nm.len()
    }

    /// The atmosphere: its ozone, its aerosol.
    #[must_use]
    pub fn air(&self) -> &Air {
        &self.air
    }

    /// Whether month and latitude make no difference, since the ozone is one profile of somebody's own.
    #[must_use]
    pub fn any_place(&self) -> bool {
        self.any_place
    }

    /// Vertical optical depth of molecules and aerosol at 550 nm over that of molecules.
    #[must_use]
    pub fn turbidity(&self) -> f64 {
        self.turbidity
    }

    /// The tables that were used.
    #[must_use]
    pub fn identities(&self) -> &[Identity] {
        &self.identities
    }

    /// Unit vector to the sun's centre in the observer's frame.
    #[must_use]
    pub fn sun_direction(&self) -> DVec3 {
        self.sun_direction
    }
}

/// What the scene asks of its method.
fn conditions(scene: &Scene, turbidity: f64, polarised: bool) -> Conditions {
    Conditions {
        sun_elevation_deg: scene.sun_elevation_deg,
        altitude_km: scene.altitude_km,
        turbidity,
        polarised,
        flat: scene.flat,
    }
}

/// Refuses choices that the own tables leave no room for.
fn check_own(scene: &Scene, data: &Data) -> Result<(), SceneError> {
    let refuse = |text: String| Err(SceneError::Refused(text));
    let own = |kind: Kind| data.own().find(|identity| identity.kind == kind);
    match (own(Kind::Aerosol), scene.biome, scene.aerosol_setting()) {
        (Some(table), Some(biome), _) => {
            return refuse(format!("{} is an aerosol, and so is the biome {biome}: leave one out", table.file));
        }
        (None, None, Some(setting)) => return Err(SceneError::no_aerosol(setting)),
        _ => {}
    }
    let (kind, other, name) = match scene.ozone_source {
        OzoneSource::McPetersLabow => (Kind::OzoneLayers, Kind::OzoneProfiles, "ml"),
        OzoneSource::Arosa => (Kind::OzoneProfiles, Kind::OzoneLayers, "arosa"),
    };
    match own(kind) {
        Some(table) => refuse(format!(
            "{} is ozone of the kind {kind}, but the ozone source {name} takes {other}: leave one out",
            table.file
        )),
        None => Ok(()),
    }
}

/// The wavelength of visibilities and optical depths in nm, which every sky needs.
const REFERENCE_NM: f64 = 550.0;

/// Names the table that does not reach a wavelength of the scene. Between the first and the last they reach all.
fn check_wavelengths(scene: &Scene, data: &Data) -> Result<(), TableError> {
    let of = |kind: Kind| {
        let identity = data.identities.iter().find(|identity| identity.kind == kind);
        identity.map_or_else(|| kind.file_name(), |identity| identity.file.clone())
    };
    let wavelengths = scene.wavelengths();
    let nm = wavelengths.nm();
    let ends = [nm.first(), nm.last(), Some(&REFERENCE_NM)];
    let reach = |kind: Kind, curve: &Curve| {
        ends.into_iter().flatten().try_for_each(|&nm| curve.at(nm).map(drop)).map_err(|e| e.at(Path::new(&of(kind))))
    };
    reach(Kind::Rayleigh, &data.rayleigh.cross_section_m2)?;
    data.ozone_cross_section.coefficients.iter().try_for_each(|curve| reach(Kind::OzoneCrossSection, curve))?;
    reach(Kind::Sun, &data.sun.irradiance_w_m2_nm)
}

/// Pictures of fewer pixels than this are looked at direction by direction, and of larger ones about so many are asked where they look.
const PANORAMIC: usize = 4096;

/// Directions of a picture in which its tables are judged.
const JUDGED: usize = 64;

/// Directions all over a picture.
fn looked_at(scene: &Scene) -> Wanted {
    let (camera, (width, height)) = (scene.camera(), scene.size());
    let shape = Shape::Sphere { radius_m: EARTH_RADIUS_M };
    let highest = highest(Place::above(scene.altitude_km * KM), shape, scene.top_km * KM);
    let judged = spread(&camera, (width, height)).filter(|direction| direction.z <= highest).take(JUDGED).collect();
    let pixels = width as usize * height as usize;
    if pixels < PANORAMIC {
        return Wanted { shown: Vec::new(), each: 1, judged };
    }
    let step = ((pixels / PANORAMIC) as f64).sqrt().max(1.0) as usize;
    let rows = (0..height).step_by(step).flat_map(|y| (0..width).step_by(step).map(move |x| (x, y)));
    let shown = rows.filter_map(|(x, y)| camera.direction(f64::from(x) + 0.5, f64::from(y) + 0.5)).collect();
    let samples = scene.spp.unwrap_or_else(|| scene.default_spp()) as usize;
    Wanted { shown, each: step * step * samples, judged }
}
