//! The scene files of the thesis (Gavín 2020): the part of Mitsuba 2's XML that they use, read as a [`Scene`].
//!
//! Anything that this does not know is an error with its line; what it knows and does not take is told, and why.

use super::{CameraKind, Scene, SceneError};
use crate::atmosphere::{Depolarisation, OzoneSource};
use crate::light::{ASTRONOMICAL_UNIT_M, SOLAR_RADIUS_M};
use crate::scene::Albedo;
use crate::transport::Method;
use glam::{DMat4, DVec3};
use roxmltree::Document;
use std::collections::BTreeMap;
use std::path::Path;
use tables::units::KM;
use tables::views::Biome;
use tables::{excerpt, nearest};

/// Radius of the Earth in the files' own scale in km.
const FILES_RADIUS_KM: f64 = 6356.766;

/// Interactions from which on nothing is left of the light.
const ENOUGH: u32 = 20;

/// Which aerosol goes by which name; the spellings are the files' own.
const AEROSOLS: [(&str, Biome); 9] = [
    ("BackgroundAerosol", Biome::Background),
    ("DesertDustAerosol", Biome::DesertDust),
    ("MaritimeCleanAerosol", Biome::MaritimeClean),
    ("MaritimeMineralAerosol", Biome::MaritimeMineral),
    ("PolarAntarticAerosol", Biome::PolarAntarctic),
    ("PolarArticAerosol", Biome::PolarArctic),
    ("RemoteContinentalAerosol", Biome::RemoteContinental),
    ("RuralAerosol", Biome::Rural),
    ("UrbanAerosol", Biome::Urban),
];

/// A scene, and what was made of the file.
#[derive(Debug, Clone, PartialEq)]
pub struct Imported {
    /// What is rendered.
    pub scene: Scene,
    /// What was taken otherwise than it stands there, what was left out, and why: a sentence each.
    pub notes: Vec<String>,
}

impl Scene {
    /// Reads a scene of the thesis; files that it includes lie in `folder`.
    ///
    /// Lengths are in the unit in which `earth_radius` is 6356.766 km. North is opposite the sun's azimuth, since the file has none: the sun stands in
    /// the south.
    ///
    /// # Errors
    /// [`SceneError::File`] with the line of what is no XML, or not of this dialect.
    pub fn from_mitsuba(text: &str, folder: &Path) -> Result<Imported, SceneError> {
        let mut defaults = BTreeMap::new();
        let roots = read(text, folder, &mut defaults, 0)?;
        let mut file = File::default();
        for node in &roots {
            file.scene(node)?;
        }
        file.finish()
    }
}

/// An element with its parameters filled in.
#[derive(Debug, Clone)]
struct Node {
    tag: String,
    line: usize,
    attributes: BTreeMap<String, String>,
    children: Vec<Node>,
}

fn fail<T>(line: usize, what: impl AsRef<str>) -> Result<T, SceneError> {
    Err(SceneError::File { line, what: excerpt(what.as_ref()) })
}

/// How deep files may include each other.
const MOST_INCLUDES: u32 = 16;

/// How deep elements may lie in each other.
const MOST_DEPTH: u32 = 32;

/// The elements of a scene, defaults put in, included files in their place.
fn read(
    text: &str,
    folder: &Path,
    defaults: &mut BTreeMap<String, String>,
    depth: u32,
) -> Result<Vec<Node>, SceneError> {
    let document = Document::parse(text).or_else(|error| fail(error.pos().row as usize, error.to_string()))?;
    let line = |node: roxmltree::Node<'_, '_>| document.text_pos_at(node.range().start).row as usize;
    let root = document.root_element();
    if root.tag_name().name() != "scene" {
        return fail(line(root), format!("<{}> is no scene", excerpt(root.tag_name().name())));
    }
    match root.attribute("version") {
        Some(version) if version.starts_with("2.") => {}
        other => return fail(line(root), format!("a scene of version {:?}; 2.x is possible", other.unwrap_or("none"))),
    }
    fn convert(
        node: roxmltree::Node<'_, '_>,
        line: &dyn Fn(roxmltree::Node<'_, '_>) -> usize,
        defaults: &BTreeMap<String, String>,
        depth: u32,
    ) -> Result<Node, SceneError> {
        if depth > MOST_DEPTH {
            return fail(line(node), "elements within elements without end");
        }
        let mut attributes = BTreeMap::new();
        for attribute in node.attributes() {
            let mut value = attribute.value().to_owned();
            if let Some(name) = value.strip_prefix('$') {
                let Some(known) = defaults.get(name) else {
                    return fail(line(node), format!("${name} has no default before this line"));
                };
                value.clone_from(known);
            }
            attributes.insert(attribute.name().to_owned(), value);
        }
        let children = node.children().filter(roxmltree::Node::is_element);
        let children = children.map(|child| convert(child, line, defaults, depth + 1)).collect::<Result<_, _>>()?;
        Ok(Node { tag: node.tag_name().name().into(), line: line(node), attributes, children })
    }
    let mut nodes = Vec::new();
    for element in root.children().filter(roxmltree::Node::is_element) {
        let node = convert(element, &line, defaults, 0)?;
        match node.tag.as_str() {
            "default" => {
                // The first one counts: whoever includes a file decides.
                defaults.entry(node.get("name")?.to_owned()).or_insert(node.get("value")?.to_owned());
            }
            "include" if depth < MOST_INCLUDES => {
                let path = folder.join(node.get("filename")?);
                let included = std::fs::read_to_string(&path)
                    .or_else(|error| fail(node.line, format!("{}: cannot be read: {error}", path.display())))?;
                let folder = path.parent().unwrap_or(folder);
                let inner = read(&included, folder, defaults, depth + 1).or_else(|error| match error {
                    SceneError::File { line, what } => {
                        fail(node.line, format!("{}, line {line}: {what}", path.display()))
                    }
                    other => Err(other),
                })?;
                nodes.extend(inner);
            }
            "include" => return fail(node.line, "files include each other without end"),
            _ => nodes.push(node),
        }
    }
    Ok(nodes)
}

impl Node {
    fn get(&self, name: &str) -> Result<&str, SceneError> {
        match self.attributes.get(name) {
            Some(value) => Ok(value),
            None => fail(self.line, format!("<{}> has no {name}", self.tag)),
        }
    }

    /// Numbers, separated by commas or blanks.
    fn numbers(&self, attribute: &str) -> Result<Vec<f64>, SceneError> {
        let text = self.get(attribute)?;
        let parts = text.split([',', ' ']).filter(|part| !part.is_empty());
        let numbers: Option<Vec<f64>> = parts.map(|part| part.parse().ok().filter(|x: &f64| x.is_finite())).collect();
        match numbers.filter(|numbers| !numbers.is_empty()) {
            Some(numbers) => Ok(numbers),
            None => fail(self.line, format!("{attribute} is {:?}; a number is needed", excerpt(text))),
        }
    }

    fn number(&self) -> Result<f64, SceneError> {
        match self.numbers("value")?[..] {
            [number] => Ok(number),
            _ => fail(self.line, "one number is needed"),
        }
    }

    fn whole(&self) -> Result<u32, SceneError> {
        let number = self.number()?;
        if number.fract() == 0.0 && (0.0..=4e9).contains(&number) {
            return Ok(number as u32);
        }
        fail(self.line, format!("{number} is no whole number"))
    }

    /// A part of a vector, 0 if it is left out.
    fn part(&self, name: &str, usual: f64) -> Result<f64, SceneError> {
        if !self.attributes.contains_key(name) {
            return Ok(usual);
        }
        match self.numbers(name)?[..] {
            [number] => Ok(number),
            _ => fail(self.line, format!("{name} is one number")),
        }
    }

    /// A vector by x, y and z.
    fn vector(&self, usual: f64) -> Result<DVec3, SceneError> {
        Ok(DVec3::new(self.part("x", usual)?, self.part("y", usual)?, self.part("z", usual)?))
    }

    /// A vector of one attribute.
    fn triple(&self, name: &str) -> Result<DVec3, SceneError> {
        match self.numbers(name)?[..] {
            [x, y, z] => Ok(DVec3::new(x, y, z)),
            _ => fail(self.line, format!("{name} is three numbers")),
        }
    }

    fn truth(&self) -> Result<bool, SceneError> {
        match self.get("value")? {
            "true" => Ok(true),
            "false" => Ok(false),
            other => fail(self.line, format!("{:?} is neither true nor false", excerpt(other))),
        }
    }

    /// The element's kind, which is one of these.
    fn kind<'a>(&self, known: &[&'a str]) -> Result<&'a str, SceneError> {
        let kind = self.get("type")?;
        match known.iter().find(|name| **name == kind) {
            Some(kind) => Ok(kind),
            None => {
                let known = known.join(" or ");
                fail(self.line, format!("{} of type {:?}; {known} is known", self.tag, excerpt(kind)))
            }
        }
    }

    /// What stands here is not of the dialect.
    fn unknown<T>(&self, within: &str, known: &[&str]) -> Result<T, SceneError> {
        let name = self.attributes.get("name").map_or(String::new(), |name| format!(" {name:?}"));
        let near = self.attributes.get("name").and_then(|name| nearest(name, known.iter().copied()));
        let hint = near.map_or(String::new(), |near| format!("; did you mean {near}?"));
        fail(self.line, format!("<{}>{name} in {within} is not known{hint}", excerpt(&self.tag)))
    }

    /// Tag and name: what a parameter is.
    fn parameter(&self) -> (&str, &str) {
        (&self.tag, self.attributes.get("name").map_or("", String::as_str))
    }

    /// The matrix of a transform: each step after those before it.
    fn matrix(&self) -> Result<DMat4, SceneError> {
        let mut all = DMat4::IDENTITY;
        for step in &self.children {
            let one = match step.tag.as_str() {
                "translate" => DMat4::from_translation(step.vector(0.0)?),
                "rotate" => match step.vector(0.0)?.try_normalize() {
                    Some(axis) => DMat4::from_axis_angle(axis, step.part("angle", 0.0)?.to_radians()),
                    None => return fail(step.line, "a rotation needs an axis"),
                },
                "scale" if step.attributes.contains_key("value") => DMat4::from_scale(DVec3::splat(step.number()?)),
                "scale" => DMat4::from_scale(step.vector(1.0)?),
                "lookat" => {
                    let [origin, target, up] = [step.triple("origin")?, step.triple("target")?, step.triple("up")?];
                    let ahead = (target - origin).try_normalize();
                    let axes = ahead.and_then(|ahead| Some((up.cross(ahead).try_normalize()?, ahead)));
                    let Some((left, ahead)) = axes else {
                        return fail(step.line, "lookat has no direction, or one along its up");
                    };
                    let columns = [left.extend(0.0), ahead.cross(left).extend(0.0), ahead.extend(0.0)];
                    DMat4::from_cols(columns[0], columns[1], columns[2], origin.extend(1.0))
                }
                _ => return step.unknown("a transform", &[]),
            };
            all = one * all;
        }
        Ok(all)
    }
}

/// What the camera is, in the file's own frame and unit.
#[derive(Debug, Clone, Copy)]
struct Sensor {
    line: usize,
    kind: CameraKind,
    angle: f64,
    axis: &'static str,
    to_world: DMat4,
    size: (u32, u32),
}

/// A sphere.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Ball {
    line: usize,
    radius: f64,
    centre: DVec3,
}

/// What has been read.
#[derive(Debug, Default)]
struct File {
    sensor: Option<Sensor>,
    sun: Option<Ball>,
    planet: Option<(Ball, Option<f64>)>,
    shells: Vec<Ball>,
    air: Option<Air>,
    interactions: Option<u32>,
    samples: Option<u32>,
    notes: Vec<String>,
}

/// The medium.
#[derive(Debug, Clone, Copy)]
struct Air {
    line: usize,
    radius: f64,
    centre: DVec3,
    depolarised: bool,
    month: u32,
    biome: Option<Biome>,
    turbidity: Option<f64>,
}

impl File {
    fn scene(&mut self, node: &Node) -> Result<(), SceneError> {
        match node.tag.as_str() {
            "integrator" => self.integrator(node),
            "sensor" => self.sensor(node),
            "shape" => self.shape(node),
            "medium" => self.medium(node),
            _ => node.unknown("a scene", &[]),
        }
    }

    fn integrator(&mut self, node: &Node) -> Result<(), SceneError> {
        node.kind(&["volpath"])?;
        for child in &node.children {
            match child.parameter() {
                ("integer", "max_depth") => self.interactions = Some(child.whole()?),
                _ => return child.unknown("an integrator", &["max_depth"]),
            }
        }
        Ok(())
    }

    fn sensor(&mut self, node: &Node) -> Result<(), SceneError> {
        let kind = match node.kind(&["fisheye", "perspective"])? {
            "fisheye" => CameraKind::Fisheye,
            _ => CameraKind::Pinhole,
        };
        let angle = if kind == CameraKind::Fisheye { 180.0 } else { 50.0 };
        let size = (768, 576);
        let mut sensor = Sensor { line: node.line, kind, angle, axis: "x", to_world: DMat4::IDENTITY, size };
        for child in &node.children {
            match (child.parameter(), kind) {
                (("float", "aperture"), CameraKind::Fisheye) => sensor.angle = child.number()?,
                (("float", "fov"), CameraKind::Pinhole) => sensor.angle = child.number()?,
                (("string", "fov_axis"), CameraKind::Pinhole) => {
                    let known = ["x", "y", "diagonal", "smaller", "larger"];
                    let axis = child.get("value")?;
                    match known.into_iter().find(|name| *name == axis) {
                        Some(axis) => sensor.axis = axis,
                        None => return fail(child.line, format!("fov_axis {axis:?}; {} is known", known.join(" or "))),
                    }
                }
                (("transform", "to_world"), _) => sensor.to_world = child.matrix()?,
                (("sampler", _), _) => {
                    child.kind(&["stratified", "independent"])?;
                    for one in &child.children {
                        match one.parameter() {
                            ("integer", "sample_count") => self.samples = Some(one.whole()?),
                            _ => return one.unknown("a sampler", &["sample_count"]),
                        }
                    }
                }
                (("film", _), _) => {
                    child.kind(&["hdrfilm"])?;
                    for one in &child.children {
                        match one.parameter() {
                            ("integer", "width") => sensor.size.0 = one.whole()?,
                            ("integer", "height") => sensor.size.1 = one.whole()?,
                            _ => return one.unknown("a film", &["width", "height"]),
                        }
                    }
                }
                _ => return child.unknown("this sensor", &["aperture", "fov", "fov_axis", "to_world"]),
            }
        }
        if self.sensor.replace(sensor).is_some() {
            return fail(node.line, "a second sensor");
        }
        Ok(())
    }

    fn shape(&mut self, node: &Node) -> Result<(), SceneError> {
        node.kind(&["sphere"])?;
        let (mut radius, mut centre, mut placed) = (1.0, DVec3::ZERO, DMat4::IDENTITY);
        let (mut emits, mut surface, mut inside, mut reflectance) = (false, None, false, None);
        for child in &node.children {
            match child.parameter() {
                ("float", "radius") => radius = child.number()?,
                ("point", "center") => centre = child.vector(0.0)?,
                ("transform", "to_world") => placed = child.matrix()?,
                ("boolean", "flip_normals") => _ = child.truth()?,
                ("emitter", _) => {
                    child.kind(&["area"])?;
                    emits = true;
                    for one in &child.children {
                        match one.parameter() {
                            ("spectrum" | "rgb", "radiance") => self.notes.push(format!(
                                "the sun's radiance {}: left out; the measured spectrum of the sun is taken",
                                one.get("value")?
                            )),
                            _ => return one.unknown("an emitter", &["radiance"]),
                        }
                    }
                }
                ("bsdf", _) => {
                    surface = Some(child.kind(&["diffuse", "null"])?);
                    for one in &child.children {
                        match one.parameter() {
                            ("rgb" | "spectrum", "reflectance") => reflectance = Some(self.grey(one)?),
                            ("texture", "reflectance") => {
                                one.kind(&["bitmap"])?;
                                self.notes.push(
                                    "the ground's picture: left out, the ground is uniform; a reflectance of 0.1 is taken".into(),
                                );
                                reflectance = Some(0.1);
                            }
                            _ => return one.unknown("a surface", &["reflectance"]),
                        }
                    }
                }
                ("ref", "interior") => inside = true,
                ("medium", "interior") => {
                    inside = true;
                    self.medium(child)?;
                }
                _ => return child.unknown("a sphere", &["radius", "center", "to_world", "flip_normals", "interior"]),
            }
        }
        let ball = Ball {
            line: node.line,
            radius: radius * placed.transform_vector3(DVec3::X).length(),
            centre: placed.transform_point3(centre),
        };
        match (emits, surface) {
            (true, _) => _ = self.sun.replace(ball),
            (false, Some("diffuse")) => _ = self.planet.replace((ball, reflectance)),
            (false, Some("null")) if inside => self.shells.push(ball),
            _ => return fail(node.line, "a sphere that is no sun, planet or boundary of the air"),
        }
        Ok(())
    }

    /// A reflectance, grey.
    fn grey(&mut self, node: &Node) -> Result<f64, SceneError> {
        match node.numbers("value")?[..] {
            [grey] => Ok(grey),
            [r, g, b] if r == g && g == b => Ok(r),
            [r, g, b] => {
                // Luminance of linear sRGB (ITU-R BT.709).
                let grey = 0.2126 * r + 0.7152 * g + 0.0722 * b;
                self.notes.push(format!(
                    "the ground's colour {r}, {g}, {b}: three numbers are no spectrum; its luminance {grey:.3} is taken"
                ));
                Ok(grey)
            }
            _ => fail(node.line, "a reflectance is one number or three"),
        }
    }

    fn medium(&mut self, node: &Node) -> Result<(), SceneError> {
        node.kind(&["atmosphere"])?;
        let mut air = Air {
            line: node.line,
            radius: FILES_RADIUS_KM,
            centre: DVec3::ZERO,
            depolarised: true,
            month: 1,
            biome: None,
            turbidity: None,
        };
        for child in &node.children {
            match child.parameter() {
                ("float", "earth_radius") => air.radius = child.number()?,
                ("point", "earth_center") => air.centre = child.vector(0.0)?,
                ("string", "molecular_phase_function") => {
                    air.depolarised = match child.get("value")? {
                        "cha" => true,
                        "rayleigh" => false,
                        other => return fail(child.line, format!("{other:?}; cha or rayleigh is known")),
                    };
                }
                ("integer", "month") => air.month = child.whole()?,
                ("string", "aerosol_model") => {
                    let name = child.get("value")?;
                    match AEROSOLS.iter().find(|(known, _)| *known == name) {
                        Some((_, biome)) => air.biome = Some(*biome),
                        None => {
                            let known = AEROSOLS.map(|(name, _)| name);
                            let near = nearest(name, known).map_or_else(
                                || format!("known are {}", known.join(", ")),
                                |near| format!("did you mean {near}?"),
                            );
                            return fail(child.line, format!("aerosol_model {:?} is not known; {near}", excerpt(name)));
                        }
                    }
                }
                ("float", "turbidity") => air.turbidity = Some(child.number()?),
                _ => {
                    let known = ["earth_radius", "earth_center", "molecular_phase_function", "month", "aerosol_model"];
                    return child.unknown("a medium", &known);
                }
            }
        }
        if air.radius <= 0.0 || air.radius.is_nan() {
            return fail(node.line, "earth_radius is not above 0");
        }
        _ = self.air.replace(air);
        Ok(())
    }

    fn finish(self) -> Result<Imported, SceneError> {
        let missing = |what: &str| fail(1, format!("the scene has no {what}"));
        let Some(sensor) = self.sensor else { return missing("sensor") };
        let Some(air) = self.air else { return missing("medium of type atmosphere") };
        let Some(sun) = self.sun else { return missing("sun: a sphere with an emitter") };
        let mut notes = self.notes;
        let scale_km = FILES_RADIUS_KM / air.radius;

        // Where the camera is, and its axes.
        let place = sensor.to_world.transform_point3(DVec3::ZERO) - air.centre;
        let axis = |local: DVec3| sensor.to_world.transform_vector3(local).try_normalize();
        let (Some(ahead), Some(top), Some(up)) = (axis(DVec3::Z), axis(DVec3::Y), place.try_normalize()) else {
            return fail(sensor.line, "the camera has no direction, or is in the middle of the Earth");
        };
        let altitude_km = place.length() * scale_km - FILES_RADIUS_KM;
        if altitude_km < -1e-6 {
            return fail(sensor.line, format!("the camera is {:.3} km below the ground", -altitude_km));
        }

        // The sun, south.
        let to_sun = sun.centre - air.centre - place;
        let Some(towards) = to_sun.try_normalize() else { return fail(sun.line, "the sun is at the camera") };
        let height = towards.dot(up);
        let level = |v: DVec3| (v - up * v.dot(up)).try_normalize();
        let south = level(towards).unwrap_or_else(|| level(ahead).unwrap_or_else(|| up.any_orthonormal_vector()));
        let north = -south;
        let east = north.cross(up);
        let azimuth = |v: DVec3| v.dot(east).atan2(v.dot(north)).to_degrees();
        let seen = (sun.radius / to_sun.length()).min(1.0);
        let distance_au = SOLAR_RADIUS_M / (seen * ASTRONOMICAL_UNIT_M);
        let usual = (distance_au - 1.0).abs() < 1e-3;
        let distance_au = if usual { 1.0 } else { distance_au };
        if !(0.9..=1.1).contains(&distance_au) {
            return fail(
                sun.line,
                format!(
                    "the sun is seen under {:.3} degrees; 0.48 to 0.59 are possible",
                    2.0 * seen.asin().to_degrees()
                ),
            );
        }

        // The view. Pictures are never rolled; one straight up or down says by its azimuth where its top is.
        let vertical = ahead.cross(up).length() < 1e-6;
        let view_azimuth = if vertical { azimuth(level(top).unwrap_or(north)) } else { azimuth(ahead) };
        if !vertical {
            let level_top = (up - ahead * up.dot(ahead)).normalize();
            let roll = top.dot(level_top.cross(ahead)).atan2(top.dot(level_top)).to_degrees();
            if roll.abs() > 0.01 {
                notes.push(format!(
                    "the camera's roll of {roll:.2} degrees: left out; here the vertical is up in pictures"
                ));
            }
        }
        let (width, height_px) = sensor.size;
        let fov_deg = match sensor.kind {
            CameraKind::Fisheye => sensor.angle,
            _ => {
                let (w, h) = (f64::from(width), f64::from(height_px));
                let across = match sensor.axis {
                    "y" => h,
                    "diagonal" => w.hypot(h),
                    "smaller" => w.min(h),
                    "larger" => w.max(h),
                    _ => w,
                };
                2.0 * ((0.5 * sensor.angle.to_radians()).tan() * w / across).atan().to_degrees()
            }
        };

        let top_km = self
            .shells
            .iter()
            .filter(|shell| (shell.centre - air.centre).length() < 0.01 * air.radius && shell.radius > air.radius)
            .map(|shell| shell.radius * scale_km - FILES_RADIUS_KM)
            .fold(f64::NAN, f64::max);
        if top_km.is_nan() {
            return missing("boundary of the air: a sphere of bsdf null with the medium as its interior");
        }
        if self.shells.len() > 1 {
            notes.push("the bubble around the camera: left out; nothing is needed there".into());
        }
        notes.push(format!("the Earth's radius of {FILES_RADIUS_KM} km: 6371 km is taken; altitudes stay"));
        if let Some((planet, _)) = self.planet
            && (planet.radius / air.radius - 1.0).abs() > 1e-3
        {
            return fail(planet.line, "the planet's radius is not the medium's earth_radius");
        }
        let albedo = match self.planet {
            Some((_, Some(albedo))) => albedo,
            // Mitsuba's default.
            Some((_, None)) => 0.5,
            None => {
                notes.push("no planet: a black ground is taken".into());
                0.0
            }
        };
        if let Some(samples) = self.samples {
            notes.push(format!(
                "{samples} samples a pixel: left out; solved pictures have no noise (--spp, --method paths)"
            ));
        }
        let few = self.interactions.filter(|orders| *orders < ENOUGH);
        match (self.interactions, few) {
            (Some(orders), None) => {
                notes.push(format!("a depth of {orders}: left out; light is followed to its end"));
            }
            (_, Some(orders)) => notes.push(format!("a depth of {orders}: paths end there")),
            _ => {}
        }
        notes.push(
            "ozone, aerosol and the standard atmosphere: by Airlight's tables, which correct those of the thesis"
                .into(),
        );
        if let Some(turbidity) = air.turbidity.filter(|_| air.biome.is_some()) {
            notes.push(format!(
                "a turbidity of {turbidity}: it multiplied tables that were wrong by another factor for each aerosol; here it multiplies the type's own amount"
            ));
        }
        let month = match u8::try_from(air.month) {
            Ok(month @ 1..=12) => month,
            _ => return fail(air.line, format!("month is {}; 1 to 12 is possible", air.month)),
        };
        // Rotations and differences of large numbers leave digits that the file never had: a millionth of a degree or a millimetre is kept.
        let tidy = |x: f64| (1e6 * x).round() / 1e6 + 0.0;
        let scene = Scene {
            altitude_km: tidy(altitude_km.max(0.0)),
            top_km: tidy(top_km),
            sun_elevation_deg: tidy(height.clamp(-1.0, 1.0).asin().to_degrees()),
            sun_azimuth_deg: 180.0,
            sun_distance_au: distance_au,
            month,
            ozone_source: OzoneSource::Arosa,
            biome: air.biome,
            turbidity: air.turbidity.filter(|_| air.biome.is_some()),
            depolarisation: if air.depolarised { Depolarisation::Measured } else { Depolarisation::None },
            albedo: Albedo::Grey(albedo),
            camera: sensor.kind,
            fov_deg: Some(tidy(fov_deg)),
            view_azimuth_deg: Some(tidy(view_azimuth)),
            view_elevation_deg: Some(tidy(ahead.dot(up).clamp(-1.0, 1.0).asin().to_degrees())),
            width: Some(width),
            height: Some(height_px),
            method: if few.is_some() { Method::Paths } else { Method::Solved },
            orders: few,
            ..Scene::default()
        };
        // Above the air there is no ground level to be below.
        debug_assert!(scene.altitude_km * KM >= 0.0);
        Ok(Imported { scene, notes })
    }
}

#[cfg(test)]
mod tests;
