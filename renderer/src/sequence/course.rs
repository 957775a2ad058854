//! What changes from frame to frame.

use crate::scene::{Moment, Scene, SceneError, SunPlace, horizon_dip};
use std::str::FromStr;
use tables::nearest;
use tables::units::KM;

/// What a sequence shows.
#[derive(Debug, Clone, PartialEq)]
pub enum Course {
    /// The day of the scene's date at its place, from civil dawn to civil dusk, the sun 6 degrees below the horizon.
    Day,
    /// The sun goes down, from 10 degrees above the horizon to 6 below: in even steps of elevation at the azimuth of the scene, or, if it
    /// has a date, as on its afternoon, in even steps of time.
    Sunset,
    /// From 2 m to 400 km, with the horizon in the middle if the scene does not say where to look.
    Ascent,
    /// From the scene's date to another instant, in even steps of time.
    Until(Moment),
    /// Some keys of the scene, each from one value to another.
    Tracks(Vec<Track>),
}

/// A key of a scene that goes from one value to another in even steps, an altitude h in even steps of ln(h + 0.1 km).
#[derive(Debug, Clone, PartialEq)]
pub struct Track {
    key: &'static str,
    from: f64,
    to: f64,
}

/// Keys that may change: those to which tables that are solved once answer.
const KEYS: [&str; 6] =
    ["sun_elevation_deg", "sun_azimuth_deg", "altitude_km", "view_azimuth_deg", "view_elevation_deg", "fov_deg"];

/// Elevations of the sun at the ends of a day and of a sunset.
const DAWN_DEG: f64 = -6.0;
const SUNSET_DEG: (f64, f64) = (10.0, -6.0);

/// Altitudes at the ends of an ascent in km.
const ASCENT_KM: (f64, f64) = (0.002, 400.0);

/// Below this altitude in km the steps of an ascent become even.
const LOW_KM: f64 = 0.1;

/// Half a day and the longest span of instants in seconds, and steps in which the sun's path is searched.
const HALF_DAY_S: f64 = 43_200.0;
const LONGEST_S: f64 = 2.0 * 86_400.0;
const STEP_S: f64 = 300.0;

impl FromStr for Track {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let example = "altitude_km=0.002:400";
        let parts = text.split_once('=').and_then(|(key, range)| Some((key.trim(), range.split_once(':')?)));
        let Some((name, (from, to))) = parts else {
            return Err(format!("KEY=FROM:TO is expected, such as {example}"));
        };
        let Some(key) = KEYS.into_iter().find(|key| *key == name) else {
            return Err(match nearest(name, KEYS) {
                Some(near) => format!("{} cannot change; did you mean {near}?", tables::excerpt(name)),
                None => format!("{} cannot change; {} can", tables::excerpt(name), KEYS.join(", ")),
            });
        };
        let number = |text: &str| text.trim().parse::<f64>().ok().filter(|value| value.is_finite());
        match (number(from), number(to)) {
            (Some(from), Some(to)) => Ok(Self { key, from, to }),
            _ => Err(format!("two numbers are expected after =, such as {example}")),
        }
    }
}

impl Track {
    /// The value at a share of the way.
    fn at(&self, share: f64) -> f64 {
        let Self { key, from, to } = *self;
        if share == 0.0 || share == 1.0 {
            return if share == 0.0 { from } else { to };
        }
        if key == "altitude_km" && from.min(to) >= 0.0 {
            return (from + LOW_KM) * ((to + LOW_KM) / (from + LOW_KM)).powf(share) - LOW_KM;
        }
        from + share * (to - from)
    }

    fn apply(&self, share: f64, scene: &mut Scene) {
        let value = self.at(share);
        match self.key {
            "sun_elevation_deg" => scene.sun_elevation_deg = value,
            "sun_azimuth_deg" => scene.sun_azimuth_deg = value,
            "altitude_km" => scene.altitude_km = value,
            "view_azimuth_deg" => scene.view_azimuth_deg = Some(value),
            "view_elevation_deg" => scene.view_elevation_deg = Some(value),
            _ => scene.fov_deg = Some(value),
        }
    }
}

impl Course {
    /// The scenes of `count` frames, the first and the last at the ends of the course, each valid. They have no date: what it says of
    /// the sun stands in them, its month and distance (6e-4 of the light in two days) as in `scene`. The camera stands still: where
    /// the scene does not say where to look, all look where the middle frame does; when the altitude changes they look at the horizon.
    ///
    /// # Errors
    /// [`SceneError::Refused`] for a course by the sun's path of a scene without a date, of which no frame would have light, or that is
    /// longer than two days; else as [`Scene::validate`].
    pub fn frames(&self, scene: &Scene, count: usize) -> Result<Vec<Scene>, SceneError> {
        let share = |i: usize| if count > 1 { i as f64 / (count - 1) as f64 } else { 0.0 };
        // Without a date a longitude says of the map alone where one is.
        let longitude_deg = scene.longitude_deg.filter(|_| scene.has_texture());
        let mut frames = vec![Scene { date: None, longitude_deg, ..scene.clone() }; count];
        let span = match (self, scene.date) {
            (Self::Day, _) => Some(day(&Path::of(scene, "a day")?)?),
            (Self::Sunset, Some(_)) => Some(evening(&Path::of(scene, "a sunset")?)?),
            (Self::Until(end), _) => Some(until(&Path::of(scene, "a span of time")?, end)?),
            _ => None,
        };
        let own;
        let tracks = match self {
            Self::Tracks(tracks) => tracks.as_slice(),
            Self::Sunset if span.is_none() => {
                own = [Track { key: "sun_elevation_deg", from: SUNSET_DEG.0, to: SUNSET_DEG.1 }];
                &own
            }
            Self::Ascent => {
                own = [Track { key: "altitude_km", from: ASCENT_KM.0, to: ASCENT_KM.1 }];
                &own
            }
            _ => &[],
        };
        for (i, frame) in frames.iter_mut().enumerate() {
            if let Some((begin, end)) = span {
                let sun = Path::of(scene, "")?.sun(begin + share(i) * (end - begin))?;
                (frame.sun_elevation_deg, frame.sun_azimuth_deg) = (sun.elevation_deg, sun.azimuth_deg);
            }
            tracks.iter().for_each(|track| track.apply(share(i), frame));
        }
        let rises = tracks.iter().any(|track| track.key == "altitude_km");
        if let Some((azimuth, _)) = frames.get(count / 2).map(Scene::view_deg) {
            for frame in &mut frames {
                frame.view_azimuth_deg.get_or_insert(azimuth);
                if rises && !frame.camera.is_whole() {
                    let horizon = -horizon_dip(frame.altitude_km * KM).to_degrees();
                    frame.view_elevation_deg.get_or_insert(horizon);
                }
            }
        }
        frames.iter().try_for_each(Scene::validate)?;
        Ok(frames)
    }
}

/// The sun's path over a place.
struct Path {
    date: Moment,
    latitude_deg: f64,
    longitude_deg: f64,
}

impl Path {
    fn of(scene: &Scene, what: &str) -> Result<Self, SceneError> {
        match (scene.date, scene.longitude_deg) {
            (Some(date), Some(longitude_deg)) => Ok(Self { date, latitude_deg: scene.latitude_deg, longitude_deg }),
            _ => Err(SceneError::Refused(format!(
                "{what} needs a date and a place: --date 2026-06-21T12:00:00+02:00 --latitude 48.2 --longitude 16.4"
            ))),
        }
    }

    /// The sun so many seconds after the date.
    fn sun(&self, seconds: f64) -> Result<SunPlace, SceneError> {
        self.date.sun_after(seconds, self.latitude_deg, self.longitude_deg)
    }

    /// Elevations from `begin` for half a day, forwards or backwards, at every step.
    fn elevations(&self, begin: f64, step: f64) -> Result<Vec<(f64, f64)>, SceneError> {
        let times = (0..=(HALF_DAY_S / STEP_S) as u32).map(|i| begin + f64::from(i) * step);
        times.map(|time| Ok((time, self.sun(time)?.elevation_deg))).collect()
    }

    /// When the sun is highest in the twenty-four hours about the date.
    fn noon(&self) -> Result<(f64, f64), SceneError> {
        let mut all = self.elevations(0.0, STEP_S)?;
        all.extend(self.elevations(0.0, -STEP_S)?);
        let noon = all.into_iter().max_by(|a, b| a.1.total_cmp(&b.1));
        noon.ok_or_else(|| SceneError::Refused(format!("date {}: no sun", self.date)))
    }

    /// When, from noon on in steps of either sign, the sun first stands as low as that, linear between two steps; half a day later if it
    /// does not.
    fn sets(&self, noon: f64, step: f64, low_deg: f64) -> Result<f64, SceneError> {
        let all = self.elevations(noon, step)?;
        let pair = all.windows(2).find(|pair| pair[1].1 <= low_deg);
        Ok(pair.map_or(noon + step.signum() * HALF_DAY_S, |pair| {
            let ((from, high), (to, low)) = (pair[0], pair[1]);
            from + (to - from) * ((high - low_deg) / (high - low)).clamp(0.0, 1.0)
        }))
    }
}

/// From civil dawn to civil dusk, in seconds after the date.
fn day(path: &Path) -> Result<(f64, f64), SceneError> {
    let (noon, high) = path.noon()?;
    if high <= DAWN_DEG {
        return Err(SceneError::Refused(format!("date {}: the sun stays at {high:.1} degrees or below", path.date)));
    }
    Ok((path.sets(noon, -STEP_S, DAWN_DEG)?, path.sets(noon, STEP_S, DAWN_DEG)?))
}

/// The end of a day, from noon if the sun is low then.
fn evening(path: &Path) -> Result<(f64, f64), SceneError> {
    let (_, dusk) = day(path)?;
    let (noon, high) = path.noon()?;
    Ok((if high > SUNSET_DEG.0 { path.sets(noon, STEP_S, SUNSET_DEG.0)? } else { noon }, dusk))
}

/// From the date to another instant.
fn until(path: &Path, end: &Moment) -> Result<(f64, f64), SceneError> {
    let seconds = path.date.seconds_until(end)?;
    if !(0.0..=LONGEST_S).contains(&seconds) {
        let text =
            format!("{end} is not within two days after {}, for ozone and distance are those of one day", path.date);
        return Err(SceneError::Refused(text));
    }
    Ok((0.0, seconds))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::CameraKind;

    fn vienna() -> Scene {
        let text = "latitude_deg = 48.2\nlongitude_deg = 16.4\ndate = 2026-06-21T15:00:00+02:00\n";
        Scene::from_toml(text).expect("reads")
    }

    #[test]
    fn a_day_goes_from_dawn_to_dusk_over_noon() {
        let frames = Course::Day.frames(&vienna(), 25).expect("a day");
        let elevation = |i: usize| frames[i].sun_elevation_deg;
        // The path is linear within five minutes: the sun goes 0.9 degrees in them, and bends by less than a hundredth of that.
        assert!((elevation(0) - DAWN_DEG).abs() < 0.02 && (elevation(24) - DAWN_DEG).abs() < 0.02, "{}", elevation(0));
        // 90 - 48.2 + 23.44 degrees, at a frame within minutes of noon.
        assert!((elevation(12) - 65.24).abs() < 0.1, "{}", elevation(12));
        assert!(frames[0].sun_azimuth_deg < 90.0 && frames[24].sun_azimuth_deg > 270.0);
        assert!(
            frames.iter().all(|frame| frame.view_azimuth_deg == frames[0].view_azimuth_deg && frame.date.is_none())
        );
        let error = Course::Day.frames(&Scene::default(), 3).expect_err("no date").to_string();
        assert!(error.contains("--date"), "{error}");
        let polar = Scene { latitude_deg: 85.0, longitude_deg: Some(0.0), ..vienna() };
        let winter = Scene { date: "2026-12-21T12:00:00Z".parse().ok(), ..polar };
        assert!(Course::Day.frames(&winter, 3).expect_err("night").to_string().contains("stays at"));
    }

    #[test]
    fn the_map_stays_below_the_observer() {
        let albedo = crate::scene::Albedo::Ground("earth".into());
        let earth = Scene { albedo, longitude_deg: Some(-20.0), ..Scene::default() };
        let frames = Course::Ascent.frames(&earth, 3).expect("an ascent");
        assert!(frames.iter().all(|frame| frame.longitude_deg == Some(-20.0)));
        let dated = Course::Day.frames(&vienna(), 3).expect("a day");
        assert!(dated.iter().all(|frame| frame.longitude_deg.is_none()), "the sun stands in the frames");
    }

    #[test]
    fn a_sunset_follows_the_date_or_stays_at_its_azimuth() {
        let frames = Course::Sunset.frames(&vienna(), 9).expect("a sunset");
        assert!((frames[0].sun_elevation_deg - 10.0).abs() < 0.02 && (frames[8].sun_elevation_deg + 6.0).abs() < 0.02);
        assert!(frames[8].sun_azimuth_deg > frames[0].sun_azimuth_deg + 10.0, "it goes north as it sets");
        let frames = Course::Sunset.frames(&Scene::default(), 3).expect("a sunset");
        assert_eq!(frames.iter().map(|f| f.sun_elevation_deg).collect::<Vec<_>>(), [10.0, 2.0, -6.0]);
    }

    #[test]
    fn an_ascent_looks_at_the_horizon_all_the_way() {
        let scene = Scene { camera: CameraKind::Pinhole, ..Scene::default() };
        let frames = Course::Ascent.frames(&scene, 101).expect("an ascent");
        assert_eq!((frames[0].altitude_km, frames[100].altitude_km), (0.002, 400.0));
        let steps: Vec<f64> = frames
            .windows(2)
            .map(|pair| pair[1].view_elevation_deg.expect("set") - pair[0].view_elevation_deg.expect("set"))
            .collect();
        // The dip goes from 0.05 to 19.8 degrees; nowhere does a frame turn by more than a degree.
        assert!(steps.iter().all(|step| *step < 0.0 && *step > -1.0), "{steps:?}");
    }

    #[test]
    fn keys_go_from_one_value_to_another_and_no_others() {
        let track = |text: &str| text.parse::<Track>();
        let tracks = Course::Tracks(vec![
            track("sun_elevation_deg=20:-4").expect("a track"),
            track("fov_deg=60:30").expect("a track"),
        ]);
        let scene = Scene { camera: CameraKind::Pinhole, ..Scene::default() };
        let frames = tracks.frames(&scene, 3).expect("valid");
        let got: Vec<_> = frames.iter().map(|f| (f.sun_elevation_deg, f.fov_deg)).collect();
        assert_eq!(got, [(20.0, Some(60.0)), (8.0, Some(45.0)), (-4.0, Some(30.0))]);
        assert!(track("altitude=0:4").expect_err("no key").contains("altitude_km"));
        assert!(track("biome=0:4").expect_err("no key").contains("sun_elevation_deg, "));
        assert!(track("fov_deg=60").expect_err("one").contains("KEY=FROM:TO"));
        assert!(track("fov_deg=60:x").expect_err("no number").contains("two numbers"));
        let below = Course::Tracks(vec![track("altitude_km=-1:4").expect("a track")]).frames(&scene, 3);
        assert!(below.expect_err("below the ground").to_string().contains("altitude is -1"));
    }

    #[test]
    fn a_span_of_time_ends_at_its_instant() {
        let end: Moment = "2026-06-21T21:00:00+02:00".parse().expect("an instant");
        let frames = Course::Until(end).frames(&vienna(), 2).expect("six hours");
        let sun = end.sun(48.2, 16.4).expect("a place");
        // Julian dates have steps of 4e-5 s.
        assert!((frames[1].sun_elevation_deg - sun.elevation_deg).abs() < 1e-5);
        assert_eq!(frames[0].sun_elevation_deg, vienna().sun_elevation_deg);
        assert!(Course::Until("2026-06-21T12:00:00Z".parse().expect("an instant")).frames(&vienna(), 2).is_err());
    }
}
