//! An instant, and where the sun stands then.

use super::SceneError;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use solar_positioning::time::JulianDate;
use solar_positioning::{Location, SolarPositions, delta_t};
use std::fmt::{Display, Formatter};
use std::str::FromStr;
use toml::value::{Datetime, Offset};

/// Seconds of a day.
const DAY_S: f64 = 86_400.0;

/// A date with a time of day and its offset from UTC, as of RFC 3339: `2026-06-21T18:30:00+02:00`, `2026-06-21T16:30:00Z`. Years 0 to 6000.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moment(Datetime);

/// Where the sun stands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SunPlace {
    /// True elevation of its centre in degrees, as seen from the ground: refraction is left out, parallax is not.
    pub elevation_deg: f64,
    /// Azimuth in degrees clockwise from north.
    pub azimuth_deg: f64,
    /// Distance in astronomical units.
    pub distance_au: f64,
}

impl Moment {
    /// Month of the date, 1 to 12.
    #[must_use]
    pub fn month(&self) -> u8 {
        self.0.date.map_or(1, |date| date.month)
    }

    /// Where the sun stands then at a place of sea level, latitude north positive and longitude east positive in degrees: direction by the
    /// algorithm SPA (Reda & Andreas 2004, 0.0003 degrees) of the crate `solar-positioning`, with its estimate of TT − UT1.
    ///
    /// # Errors
    /// [`SceneError::Refused`] with what the crate says of it: a date that no calendar has, a place outside the Earth.
    pub fn sun(&self, latitude_deg: f64, longitude_deg: f64) -> Result<SunPlace, SceneError> {
        self.sun_after(0.0, latitude_deg, longitude_deg)
    }

    /// As [`Moment::sun`], so many seconds later, or earlier if they are negative.
    ///
    /// # Errors
    /// As [`Moment::sun`].
    pub fn sun_after(&self, seconds: f64, latitude_deg: f64, longitude_deg: f64) -> Result<SunPlace, SceneError> {
        let refuse = |error: solar_positioning::Error| SceneError::Refused(format!("date {self}: {error}"));
        let time = self.julian(seconds).map_err(refuse)?;
        let place = Location { latitude: latitude_deg, longitude: longitude_deg };
        let sun = SolarPositions::new().at_from_julian(time, place, 0.0, None).map_err(refuse)?;
        let distance_au = distance_au(time.julian_date());
        Ok(SunPlace { elevation_deg: sun.elevation_angle(), azimuth_deg: sun.azimuth(), distance_au })
    }

    /// Seconds from this instant to another, by their Julian dates: to 1e-4 s.
    ///
    /// # Errors
    /// As [`Moment::sun`].
    pub fn seconds_until(&self, other: &Self) -> Result<f64, SceneError> {
        let of = |moment: &Self| {
            let refuse = |error: solar_positioning::Error| SceneError::Refused(format!("date {moment}: {error}"));
            moment.julian(0.0).map(|time| time.julian_date()).map_err(refuse)
        };
        Ok((of(other)? - of(self)?) * DAY_S)
    }

    /// The instant so many seconds later.
    fn julian(&self, later_s: f64) -> solar_positioning::Result<JulianDate> {
        let Datetime { date: Some(date), time: Some(time), offset: Some(offset) } = self.0 else {
            // Not made by `from_str`.
            return JulianDate::new(f64::NAN, 0.0);
        };
        let seconds = f64::from(time.second.unwrap_or(0)) + 1e-9 * f64::from(time.nanosecond.unwrap_or(0));
        let (year, month) = (i32::from(date.year), u32::from(date.month));
        let delta_t = delta_t::estimate_from_date(year, month)?;
        let (day, hour, minute) = (u32::from(date.day), u32::from(time.hour), u32::from(time.minute));
        // A leap second is the next.
        let local = JulianDate::from_utc(year, month, day, hour, minute, seconds.min(59.999), delta_t)?;
        let minutes = match offset {
            Offset::Z => 0,
            Offset::Custom { minutes } => minutes,
        };
        JulianDate::new(local.julian_date() - f64::from(minutes) / 1440.0 + later_s / DAY_S, delta_t)
    }
}

/// The sun's distance in astronomical units at a Julian date, to 2e-4 from 1950 to 2050 (The Astronomical Almanac, low-precision formulas for the
/// sun): 1.00014 − 0.01671 cos g − 0.00014 cos 2g with the mean anomaly g = 357.529° + 0.9856003° n, n days from 2000 January 1.5.
fn distance_au(julian_date: f64) -> f64 {
    let n = julian_date - 2_451_545.0;
    let g = (357.529 + 0.985_600_3 * n).to_radians();
    1.000_14 - 0.016_71 * g.cos() - 0.000_14 * (2.0 * g).cos()
}

impl FromStr for Moment {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wanted = "2026-06-21T18:30:00+02:00 (or Z for UTC)";
        match text.parse::<Datetime>() {
            Ok(datetime @ Datetime { date: Some(_), time: Some(_), offset: Some(_) }) => Ok(Self(datetime)),
            Ok(_) => Err(format!("{:?} lacks a date, a time or its offset from UTC: {wanted}", tables::excerpt(text))),
            Err(_) => Err(format!("{:?} is no date: {wanted}", tables::excerpt(text))),
        }
    }
}

impl Display for Moment {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        self.0.fmt(f)
    }
}

impl Serialize for Moment {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        to.collect_str(self)
    }
}

impl<'de> Deserialize<'de> for Moment {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        String::deserialize(from)?.parse().map_err(serde::de::Error::custom)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn moment(text: &str) -> Moment {
        text.parse().expect("a moment")
    }

    #[test]
    fn the_sun_stands_where_the_reference_of_the_algorithm_has_it() {
        // Reda & Andreas 2004, table A5.1: 2003 October 17, 12:30:30 at 7 hours west of UTC, latitude 39.742476, longitude -105.1786; zenith
        // angle 50.11162 and azimuth 194.34024 at 1830 m with refraction. Refraction at 39.9 degrees is 0.0194 degrees less pressure at
        // that height (0.016), 1830 m change parallax by 1e-6.
        let sun = moment("2003-10-17T12:30:30-07:00").sun(39.742_476, -105.178_6).expect("a place");
        assert!((sun.elevation_deg - (90.0 - 50.111_62)).abs() < 0.025, "{}", sun.elevation_deg);
        assert!(sun.elevation_deg < 90.0 - 50.111_62, "refraction lifts the sun");
        assert!((sun.azimuth_deg - 194.340_24).abs() < 1e-3, "{}", sun.azimuth_deg);
        // Table A5.1 has the distance 0.9965422974.
        assert!((sun.distance_au - 0.996_542_3).abs() < 2e-4, "{}", sun.distance_au);
    }

    #[test]
    fn an_offset_is_the_same_instant() {
        let [a, b] = ["2026-06-21T18:30:00+02:00", "2026-06-21T16:30:00Z"].map(|text| moment(text).sun(48.0, 16.0));
        let (a, b) = (a.expect("a place"), b.expect("a place"));
        // Doubles of Julian dates have steps of 4e-5 s, and the sun moves 15 degrees an hour.
        assert!((a.elevation_deg - b.elevation_deg).abs() < 1e-6 && (a.azimuth_deg - b.azimuth_deg).abs() < 1e-6);
    }

    #[test]
    fn the_sun_is_nearest_in_january() {
        // Perihelion 2026 January 3, 0.983302 au; aphelion 2026 July 6, 1.016644 au (The Astronomical Almanac).
        for (text, au) in [("2026-01-03T17:00:00Z", 0.983_302), ("2026-07-06T17:00:00Z", 1.016_644)] {
            let sun = moment(text).sun(0.0, 0.0).expect("a place");
            assert!((sun.distance_au - au).abs() < 2e-4, "{text}: {}", sun.distance_au);
        }
    }

    #[test]
    fn what_is_no_instant_is_refused_with_an_example() {
        for text in ["2026-06-21", "18:30:00", "2026-06-21T18:30:00", "noon", "2026-02-30T12:00:00Z"] {
            let error = text.parse::<Moment>().map_or_else(
                |error| error,
                |moment| moment.sun(0.0, 0.0).map_or_else(|e| e.to_string(), |sun| format!("{sun:?}")),
            );
            assert!(error.contains("2026-06-21T18:30:00+02:00") || error.contains("2026-02-30"), "{text}: {error}");
            assert!(!error.contains("SunPlace"), "{text}: {error}");
        }
    }
}
