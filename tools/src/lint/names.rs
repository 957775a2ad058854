//! What a column means, from its name: quantity, unit, and of what.

use tables::views::Biome;

/// What the numbers of a column are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs, reason = "the names say it")]
pub(super) enum Quantity {
    Wavelength,
    Altitude,
    Geopotential,
    Temperature,
    Pressure,
    NumberDensity,
    MassDensity,
    Extinction,
    Scattering,
    Absorption,
    CrossSection,
    Albedo,
    Asymmetry,
    Angstrom,
    OpticalDepth,
    Reflectance,
    IndexReal,
    IndexImaginary,
    King,
    Depolarization,
    Gamma,
    Irradiance,
    Matching(u8),
    Limb(u8),
    DiscMean,
    Column,
    MixingRatio,
    Fraction,
    Humidity,
    ScaleHeight,
    Radius,
    Width,
    Spread,
    Key,
    Text,
    Other,
}

/// What a unit measures; values are turned into SI by its factor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Unit {
    /// Powers of metre and kilogram, or another quantity.
    pub(super) dimension: Dimension,
    /// SI value of one unit (nanometres for wavelengths are made elsewhere).
    pub(super) factor: f64,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs, reason = "the names say it")]
pub(super) enum Dimension {
    One,
    Length,
    Area,
    PerLength,
    PerVolume,
    MassDensity,
    Pressure,
    Temperature,
    Irradiance,
    Dobson,
}

/// The meaning of a column.
#[derive(Debug, Clone)]
pub(super) struct Meaning {
    pub(super) quantity: Quantity,
    /// What is left of the name: a biome, a material, a layer, lower case.
    pub(super) subject: String,
    pub(super) biome: Option<Biome>,
    pub(super) unit: Option<Unit>,
    /// Wavelength in the name, such as `550nm`, in nm.
    pub(super) at_nm: Option<f64>,
    /// Words of the name, lower case, without units.
    pub(super) words: Vec<String>,
}

impl Meaning {
    /// The SI value of one unit of the column; 1 where the unit is not known.
    pub(super) fn factor(&self) -> f64 {
        self.unit.map_or(1.0, |unit| unit.factor)
    }

    pub(super) fn dimension(&self) -> Option<Dimension> {
        self.unit.map(|unit| unit.dimension)
    }

    pub(super) fn says(&self, word: &str) -> bool {
        self.words.iter().any(|w| w == word)
    }
}

/// The unit that a word of a name or a unit of the field's standard terms means.
pub(super) fn unit(text: &str) -> Option<Unit> {
    let plain: String = text
        .chars()
        .filter_map(|c| match c {
            '²' => Some('2'),
            '³' => Some('3'),
            '¹' => Some('1'),
            '⁻' => Some('-'),
            'µ' | 'μ' => Some('u'),
            '^' | '*' => None,
            _ => Some(c),
        })
        .collect();
    let one = |dimension, factor| Some(Unit { dimension, factor });
    match plain.trim() {
        "1" => return one(Dimension::One, 1.0),
        "percent" | "%" => return one(Dimension::One, 0.01),
        "ppmv" | "ppm" => return one(Dimension::One, 1e-6),
        "ppbv" | "ppb" => return one(Dimension::One, 1e-9),
        "pa" | "Pa" => return one(Dimension::Pressure, 1.0),
        "hpa" | "hPa" | "mbar" => return one(Dimension::Pressure, 100.0),
        "kpa" | "kPa" => return one(Dimension::Pressure, 1e3),
        "k" | "K" | "kelvin" => return one(Dimension::Temperature, 1.0),
        "du" | "DU" => return one(Dimension::Dobson, 1.0),
        "kg m-3" => return one(Dimension::MassDensity, 1.0),
        "g cm-3" => return one(Dimension::MassDensity, 1e3),
        "W m-2 nm-1" => return one(Dimension::Irradiance, 1.0),
        "W m-2 um-1" => return one(Dimension::Irradiance, 1e-3),
        // km^-1 for one particle in each cubic centimetre.
        "km-1 cm3" => return one(Dimension::Area, 1e-9),
        "text" => return None,
        _ => {}
    }
    let digits = plain.trim_end_matches(|c: char| c.is_ascii_digit() || c == '-');
    let (power, length) = (&plain[digits.len()..], digits.trim());
    let metre = match length.to_lowercase().as_str() {
        "m" => 1.0,
        "km" => 1e3,
        "cm" => 1e-2,
        "mm" => 1e-3,
        "um" | "micron" | "microns" => 1e-6,
        "nm" => 1e-9,
        "mum" => 1e-6,
        _ => return None,
    };
    match power {
        "" => one(Dimension::Length, metre),
        "2" => one(Dimension::Area, metre * metre),
        "-1" => one(Dimension::PerLength, 1.0 / metre),
        "-3" => one(Dimension::PerVolume, metre.powi(-3)),
        // As `number_density_m3`: the volume that the density is of.
        "3" => one(Dimension::PerVolume, metre.powi(-3)),
        _ => None,
    }
}

/// Words that say nothing of what a column is of.
const FILLERS: [&str; 36] = [
    "cross",
    "section",
    "sections",
    "coefficient",
    "coeff",
    "coef",
    "xs",
    "xsec",
    "cs",
    "sigma",
    "c",
    "q",
    "as",
    "labelled",
    "labeled",
    "querschnitt",
    "wirkungsquerschnitt",
    "wq",
    "koeffizient",
    "per",
    "particle",
    "reference",
    "mean",
    "value",
    "values",
    "of",
    "the",
    "in",
    "total",
    "aerosol",
    "volume",
    "efficiency",
    "single",
    "spectral",
    "particles",
    "at",
];

/// Parts of a name, unit by unit and word by word.
fn split(name: &str) -> (Vec<String>, Option<Unit>, Option<f64>) {
    let lower_units: String = name.replace("km-1_per_cm-3", "\u{1}").replace("km-1 per cm-3", "\u{1}");
    let mut words = Vec::new();
    let (mut found, mut at_nm) = (None, None);
    if name.chars().all(char::is_alphanumeric) && name.len() < 3 {
        // One letter alone is a name, such as the k of a refractive index.
        return (vec![name.to_lowercase()], None, None);
    }
    let text = lower_units.replace("kg_m3", "\u{2}").replace("kg_m-3", "\u{2}").replace("w_m2_nm", "\u{3}");
    for piece in text.split(|c: char| c == '_' || c.is_whitespace() || "()[]{}/.,:;|=".contains(c)) {
        match piece {
            "" => continue,
            "\u{1}" => found = Some(Unit { dimension: Dimension::Area, factor: 1e-9 }),
            "\u{2}" => found = Some(Unit { dimension: Dimension::MassDensity, factor: 1.0 }),
            "\u{3}" => found = Some(Unit { dimension: Dimension::Irradiance, factor: 1.0 }),
            _ => {
                let low = piece.to_lowercase();
                if let Some(nm) = low.strip_suffix("nm").and_then(|n| n.parse().ok()) {
                    at_nm = Some(nm);
                } else if let Some(one) = unit(piece).or_else(|| unit(&low)).filter(|_| !is_number(piece)) {
                    found = Some(one);
                } else {
                    words.extend(words_of(piece));
                }
            }
        }
    }
    // A unit glued to the last word by a dash, such as `sca-km2`.
    if found.is_none()
        && words.len() > 1
        && let Some(one) = unit(&words[words.len() - 1]).filter(|_| !is_number(&words[words.len() - 1]))
    {
        found = Some(one);
        words.pop();
    }
    (words, found, at_nm)
}

/// A bare number is no unit.
fn is_number(piece: &str) -> bool {
    piece.parse::<f64>().is_ok()
}

/// Splits at dashes and where small letters end, such as `DesertDust`.
fn words_of(piece: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let mut small = false;
    for c in piece.chars() {
        if c == '-' || c == '+' {
            words.push(String::new());
        } else {
            if c.is_uppercase() && small {
                words.push(String::new());
            }
            if let Some(last) = words.last_mut() {
                last.extend(c.to_lowercase());
            }
        }
        small = c.is_lowercase();
    }
    words.retain(|word| !word.is_empty());
    words
}

/// Whether a word begins with one of these.
fn begins(word: &str, with: &[&str]) -> bool {
    with.iter().any(|w| word.starts_with(w))
}

fn among(word: &str, list: &[&str]) -> bool {
    list.contains(&word)
}

/// The quantity that one word means by itself.
fn optics_of(word: &str) -> Option<Quantity> {
    let word = word.trim_end_matches(|c: char| c.is_ascii_digit());
    if begins(word, &["albedo", "einfachstreualbedo", "streualbedo"])
        || among(word, &["ssa", "omega", "w", "sscalb", "sca alb"])
    {
        return Some(Quantity::Albedo);
    }
    if begins(word, &["asym"]) || among(word, &["g", "hg", "gpar", "meancosine"]) {
        return Some(Quantity::Asymmetry);
    }
    if begins(word, &["scat", "streu", "dispers", "diffus"])
        || among(word, &["sca", "scs", "sct", "csca", "qsca", "ksca", "bsca", "bscat", "scas", "ssca", "sc"])
    {
        return Some(Quantity::Scattering);
    }
    if begins(word, &["abso"]) || among(word, &["abs", "cabs", "qabs", "kabs", "babs", "sabs", "absn", "ab"]) {
        return Some(Quantity::Absorption);
    }
    if begins(word, &["extin", "extink", "attenu"])
        || among(word, &["ext", "cext", "qext", "kext", "bext", "sext", "att", "ex"])
    {
        return Some(Quantity::Extinction);
    }
    None
}

/// The quantity of a whole name, and the words that are left.
fn quantity(words: &[String], unit: Option<Unit>) -> (Quantity, Vec<String>) {
    let has = |list: &[&str]| words.iter().any(|w| among(w, list));
    let starts = |list: &[&str]| words.iter().any(|w| begins(w, list));
    let rest = |used: &dyn Fn(&str) -> bool| words.iter().filter(|w| !used(w)).cloned().collect::<Vec<_>>();
    let dimension = unit.map(|u| u.dimension);
    if starts(&["ratio"]) || has(&["error", "fehler", "uncertainty"]) {
        return (Quantity::Other, words.to_vec());
    }
    if starts(&["wavelength", "wellenl", "lambda", "wavelen"])
        || has(&["wl", "wvl", "lam"])
        || (words.is_empty() && dimension == Some(Dimension::Length))
    {
        let bound = has(&["min", "max"]);
        return (if bound { Quantity::Other } else { Quantity::Wavelength }, Vec::new());
    }
    if starts(&["bar"]) && words.len() == 2 || words.len() == 1 && begins(&words[0], &["xbar", "ybar", "zbar"]) {
        let i = ["x", "y", "z"].iter().position(|letter| words[0].starts_with(letter));
        if let Some(i) = i {
            return (Quantity::Matching(i as u8), Vec::new());
        }
    }
    if starts(&["geopot"]) {
        return (Quantity::Geopotential, Vec::new());
    }
    if starts(&["scale"]) && starts(&["height"]) || starts(&["skalenh"]) {
        return (Quantity::ScaleHeight, Vec::new());
    }
    if (starts(&["altitude", "hoehe", "höhe", "height", "geometric"]) || has(&["z", "alt"]))
        && matches!(dimension, None | Some(Dimension::Length))
    {
        return (Quantity::Altitude, Vec::new());
    }
    if starts(&["temperat"]) || has(&["temp", "t"]) && dimension == Some(Dimension::Temperature) {
        return (Quantity::Temperature, Vec::new());
    }
    if starts(&["pressure", "druck"])
        || has(&["p", "pres", "press"]) && matches!(dimension, None | Some(Dimension::Pressure))
    {
        return (Quantity::Pressure, Vec::new());
    }
    if starts(&["king"]) {
        return (Quantity::King, Vec::new());
    }
    if starts(&["depolar"]) || has(&["rho"]) && dimension.is_none() {
        return (Quantity::Depolarization, Vec::new());
    }
    if has(&["gamma"]) {
        return (Quantity::Gamma, Vec::new());
    }
    if starts(&["irradiance", "bestrahl"]) || dimension == Some(Dimension::Irradiance) {
        return (Quantity::Irradiance, Vec::new());
    }
    if starts(&["angstr", "ångstr", "angström"]) || has(&["aae", "sae", "eae"]) {
        return (Quantity::Angstrom, rest(&|w| begins(w, &["angstr", "ångstr", "expon"])));
    }
    if starts(&["optical"]) && starts(&["depth", "thick"]) || has(&["aod", "aot", "tau"]) || starts(&["optische"]) {
        let used =
            |w: &str| begins(w, &["optical", "depth", "thick", "optisch", "dicke"]) || among(w, &["aod", "aot", "tau"]);
        return (Quantity::OpticalDepth, rest(&used));
    }
    if starts(&["reflect", "reflex"])
        || words.len() > 1 && has(&["albedo"]) && (starts(&["ground", "surface", "boden"]))
    {
        return (Quantity::Reflectance, rest(&|w| begins(w, &["reflect", "reflex"])));
    }
    if has(&["vmr"]) || starts(&["mixing"]) || starts(&["mole"]) && starts(&["fraction"]) {
        return (Quantity::MixingRatio, rest(&|w| begins(w, &["mixing", "ratio", "mole", "fraction"]) || w == "vmr"));
    }
    if dimension == Some(Dimension::Dobson) || starts(&["column"]) && !starts(&["fraction"]) && has(&["du", "ozone"]) {
        let spread = starts(&["stand", "dev"]) || has(&["sd", "std"]);
        return (if spread { Quantity::Spread } else { Quantity::Column }, words.to_vec());
    }
    if has(&["fraction", "share", "anteil"]) {
        return (Quantity::Fraction, words.to_vec());
    }
    if starts(&["humid", "feuchte"]) || has(&["rh"]) {
        return (Quantity::Humidity, Vec::new());
    }
    if starts(&["densit", "dichte", "anzahldichte", "teilchendichte", "konzentr", "concentr"])
        || has(&["number"])
        || matches!(dimension, Some(Dimension::PerVolume | Dimension::MassDensity))
    {
        let mass = matches!(dimension, Some(Dimension::MassDensity));
        let used = |w: &str| begins(w, &["densit", "dichte", "number", "mass"]);
        return (if mass { Quantity::MassDensity } else { Quantity::NumberDensity }, rest(&used));
    }
    if has(&["sigma"]) && has(&["g", "log10", "geometric"]) {
        return (Quantity::Width, words.to_vec());
    }
    if starts(&["radius"]) || words.len() > 1 && words[0] == "r" && dimension == Some(Dimension::Length) {
        return (Quantity::Radius, words.to_vec());
    }
    if starts(&["disc"]) {
        return (Quantity::DiscMean, Vec::new());
    }
    if let [one] = words {
        match one.as_str() {
            "n" | "nreal" | "nr" => return (Quantity::IndexReal, Vec::new()),
            "k" | "kappa" | "ni" => return (Quantity::IndexImaginary, Vec::new()),
            _ => {}
        }
        if let Some(i) = one.strip_prefix('a').and_then(|i| i.parse().ok()) {
            return (Quantity::Limb(i), Vec::new());
        }
        if among(one, &["month", "monat", "mode", "layer", "year", "day", "latitude", "lat", "index"]) {
            return (Quantity::Key, Vec::new());
        }
    }
    if words.len() > 1 && has(&["n"]) && dimension.is_none() {
        return (Quantity::IndexReal, rest(&|w| w == "n"));
    }
    if words.len() > 1 && has(&["k"]) && dimension.is_none() {
        return (Quantity::IndexImaginary, rest(&|w| w == "k"));
    }
    optics(words, dimension)
}

/// Scattering, absorption, extinction, albedo, asymmetry, or a cross-section of no said kind.
fn optics(words: &[String], dimension: Option<Dimension>) -> (Quantity, Vec<String>) {
    let albedo = words.iter().any(|w| optics_of(w) == Some(Quantity::Albedo));
    let wanted = |q: Quantity| !albedo || q == Quantity::Albedo;
    let found = words.iter().filter_map(|w| optics_of(w)).find(|q| wanted(*q));
    if let Some(quantity) = found {
        return (quantity, words.iter().filter(|w| optics_of(w).is_none()).cloned().collect());
    }
    // sigma_s, sigma_a, sigma_e and the like.
    for pair in words.windows(2).filter(|p| among(&p[0], &["sigma", "c", "q", "mu", "k", "beta", "b"])) {
        let quantity = match pair[1].as_str() {
            "s" => Quantity::Scattering,
            "a" => Quantity::Absorption,
            "e" | "t" => Quantity::Extinction,
            _ => continue,
        };
        return (quantity, words.iter().filter(|w| **w != pair[0] && **w != pair[1]).cloned().collect());
    }
    // Behind a name, its first letter alone.
    if let [left @ .., last] = words
        && !left.is_empty()
        && let Some(quantity) = match last.as_str() {
            "s" => Some(Quantity::Scattering),
            "a" => Some(Quantity::Absorption),
            "e" => Some(Quantity::Extinction),
            _ => None,
        }
    {
        return (quantity, left.to_vec());
    }
    // Words glued together, such as `urbanscattering`.
    for word in words {
        let parts = [
            ("scatter", Quantity::Scattering),
            ("streu", Quantity::Scattering),
            ("absor", Quantity::Absorption),
            ("extin", Quantity::Extinction),
        ];
        for (part, quantity) in parts {
            if let Some(i) = word.find(part) {
                let mut left: Vec<String> = words.iter().filter(|w| *w != word).cloned().collect();
                left.push(word[..i].to_owned());
                return (quantity, left);
            }
        }
    }
    if dimension == Some(Dimension::Area) || words.iter().any(|w| begins(w, &["cross", "querschn", "wirkungsq"])) {
        return (Quantity::CrossSection, words.to_vec());
    }
    (Quantity::Other, words.to_vec())
}

/// The biome that a name speaks of, in English or German, also run together, abbreviated, or by the name of
/// the nearest type of OPAC.
pub(super) fn biome(text: &str) -> Option<Biome> {
    let lower = text.to_lowercase().replace("ü", "ue").replace("ä", "ae");
    let joined: String = lower.chars().filter(|c| c.is_ascii_alphabetic()).collect();
    let has = |part: &str| joined.contains(part);
    let word = |word: &str| lower.split(|c: char| !c.is_ascii_alphabetic()).any(|w| w == word);
    let sea = has("marit") || has("ocean") || has("marin");
    let land = has("contin") || has("kontin");
    Some(match () {
        () if has("antarc") || has("antark") || word("ant") || word("pan") => Biome::PolarAntarctic,
        () if has("arctic") || has("arkti") || word("arc") || word("par") => {
            (!has("subarct")).then_some(Biome::PolarArctic)?
        }
        () if has("desert") || has("dust") || has("wuest") || has("staub") || word("dd") || word("des") => {
            Biome::DesertDust
        }
        () if sea && has("miner") || has("maritimetropical") || has("maritimem") || word("mm") => {
            Biome::MaritimeMineral
        }
        () if sea && !has("pollut") || word("mc") => Biome::MaritimeClean,
        () if has("continentalaverage") => Biome::Rural,
        () if land && (has("remote") || has("clean") || has("abgelegen") || has("entleg"))
            || has("remotec")
            || word("rc") =>
        {
            Biome::RemoteContinental
        }
        () if has("rural") || has("laendlich") || word("rur") => Biome::Rural,
        () if has("urban") || has("stadt") || has("staedt") || has("city") || word("urb") => Biome::Urban,
        () if has("background") || has("hintergrund") || word("bg") || word("bkg") => Biome::Background,
        () => return None,
    })
}

/// What a column of this name means; `stated` is its unit where the file states it apart.
pub(super) fn meaning(name: &str, stated: Option<Unit>) -> Meaning {
    let (words, in_name, at_nm) = split(name);
    let unit = stated.or(in_name);
    let (quantity, left) = quantity(&words, unit);
    let subject: Vec<&str> = left.iter().map(String::as_str).filter(|w| !FILLERS.contains(w)).collect();
    let subject = subject.join("-");
    let biome = biome(&subject);
    Meaning { quantity, subject: biome.map_or(subject, |b| b.name().to_owned()), biome, unit, at_nm, words }
}

/// The unit that stands in a name.
pub(super) fn unit_in_name(name: &str) -> Option<Unit> {
    split(name).1
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(name: &str) -> (Quantity, String, Option<Dimension>) {
        let m = meaning(name, None);
        (m.quantity, m.subject.clone(), m.dimension())
    }

    #[test]
    fn names_are_read_whatever_their_order_and_language() {
        let area = Some(Dimension::Area);
        for (name, quantity, biome) in [
            ("DesertDust_absorption_km2_as_labelled", Quantity::Absorption, "desert-dust"),
            ("desert-dust_sca_m2", Quantity::Scattering, "desert-dust"),
            ("scattering_cross_section_PolarArctic_[cm2]", Quantity::Scattering, "polar-arctic"),
            ("Streuquerschnitt_Stadt_um2", Quantity::Scattering, "urban"),
            ("absorptionsquerschnitt (Hintergrund) [m²]", Quantity::Absorption, "background"),
            ("sigma_abs_rural_km^2", Quantity::Absorption, "rural"),
            ("C_ext_maritime_clean_m2", Quantity::Extinction, "maritime-clean"),
            ("remotecontinentalscattering_m2", Quantity::Scattering, "remote-continental"),
        ] {
            assert_eq!(read(name), (quantity, biome.to_owned(), area), "{name}");
        }
        assert_eq!(read("wavelength_um").0, Quantity::Wavelength);
        assert_eq!(read("single_scattering_albedo_550nm").0, Quantity::Albedo);
        assert_eq!(read("extinction_km-1_per_cm-3").2, area);
        assert_eq!(read("number_density_m3"), (Quantity::NumberDensity, String::new(), Some(Dimension::PerVolume)));
        assert_eq!(read("lapse_rate_k_per_km").0, Quantity::Other);
    }
}
