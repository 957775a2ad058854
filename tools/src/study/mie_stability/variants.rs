//! The variants that are compared: named sets of choices, in groups of which each makes one figure.

use super::classical::{Absorption, Angular, Derivative, Form, Optics, Radial, Recipe, Sums, Terms};
use super::limits::Limit;
use super::reference::Sphere;
use crate::mie::{MieError, RefractiveIndex, Solver};
use num_complex::Complex64;

/// Every ingredient in its robust form, but for those that only tell beyond x = 1e5: the angular functions of the
/// textbook and plain sums.
pub(super) const ROBUST: Recipe = Recipe {
    form: Form::Derivative,
    derivative: Derivative::Down,
    radial: Radial::Mixed,
    terms: Terms::Full,
    angular: Angular::Textbook,
    sums: Sums::Plain,
    absorption: Absorption::Difference,
};

/// The choices of [`crate::mie`], for any precision.
pub(super) const OURS: Recipe = Recipe {
    form: Form::Ratios,
    angular: Angular::Wiscombe,
    sums: Sums::Blocked,
    absorption: Absorption::Wronskian,
    ..ROBUST
};

/// How a variant computes.
#[derive(Debug, Clone, Copy)]
pub(super) enum Method {
    /// The series in double precision.
    Double(Recipe),
    /// The series in single precision.
    Single(Recipe),
    /// A limit.
    Limit(Limit),
    /// [`crate::mie`].
    Ours,
}

/// A way to scatter light by a sphere.
#[derive(Debug, Clone, Copy)]
pub(super) struct Variant {
    /// Its name in CSV files.
    pub(super) key: &'static str,
    /// Its name in a figure.
    #[cfg_attr(not(feature = "plot"), expect(dead_code, reason = "figures show it"))]
    pub(super) title: &'static str,
    pub(super) method: Method,
}

impl Variant {
    /// What the variant finds at the size parameter `x` and index n + ik; NaN for what a limit does not have or where it is not meant.
    pub(super) fn solve(&self, x: f64, (n, k): (f64, f64)) -> Result<Optics, MieError> {
        match self.method {
            Method::Double(recipe) => Ok(recipe.solve::<f64>(x, (n, k))),
            Method::Single(recipe) => Ok(recipe.solve::<f32>(x, (n, k))),
            Method::Limit(limit) => {
                let (extinction, scattering) = limit.efficiencies(x, Complex64::new(n, k)).unwrap_or((f64::NAN, None));
                let none = Complex64::new(f64::NAN, f64::NAN);
                Ok(Optics {
                    extinction,
                    scattering: scattering.unwrap_or(f64::NAN),
                    absorption: f64::NAN,
                    backscatter: f64::NAN,
                    asymmetry: f64::NAN,
                    forward: none,
                    backward: none,
                })
            }
            Method::Ours => {
                let mut solver = Solver::new();
                let sphere = solver.sphere(RefractiveIndex::new(n, k)?, x)?;
                let q = sphere.efficiencies();
                Ok(Optics {
                    extinction: q.extinction,
                    scattering: q.scattering,
                    absorption: q.absorption,
                    backscatter: q.backscatter,
                    asymmetry: q.asymmetry,
                    forward: sphere.amplitudes(1.0)?.s1,
                    backward: sphere.amplitudes(-1.0)?.s1,
                })
            }
        }
    }

    /// Whether the variant has the quantity at all.
    pub(super) fn has(&self, quantity: Quantity) -> bool {
        match self.method {
            Method::Limit(Limit::Rayleigh | Limit::ThreeTerms) => {
                matches!(quantity, Quantity::Extinction | Quantity::Scattering)
            }
            Method::Limit(_) => quantity == Quantity::Extinction,
            Method::Double(_) | Method::Single(_) | Method::Ours => true,
        }
    }

    /// Relative errors of all quantities: infinite for what is no number, NaN for what the variant does not have, where it
    /// is not meant, and for absorption by a sphere that does not absorb.
    pub(super) fn errors(&self, sphere: &Sphere) -> Result<Errors, MieError> {
        let (found, exact) = (self.solve(sphere.x, (sphere.n, sphere.k))?, &sphere.exact);
        let meant = match self.method {
            Method::Limit(_) => found.extinction.is_finite(),
            Method::Double(_) | Method::Single(_) | Method::Ours => true,
        };
        Ok(Errors(Quantity::ALL.map(|quantity| {
            let error = quantity.error(&found, exact);
            match (meant && self.has(quantity), quantity) {
                (false, _) => f64::NAN,
                (true, Quantity::Absorption) if exact.absorption == 0.0 => f64::NAN,
                (true, _) if error.is_finite() => error,
                (true, _) => f64::INFINITY,
            }
        })))
    }
}

/// What is compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Quantity {
    Extinction,
    Scattering,
    Absorption,
    Backscatter,
    Asymmetry,
    /// Amplitude at 0 degrees.
    Forward,
    /// Amplitude at 180 degrees.
    Backward,
}

impl Quantity {
    pub(super) const ALL: [Self; 7] = [
        Self::Extinction,
        Self::Scattering,
        Self::Absorption,
        Self::Backscatter,
        Self::Asymmetry,
        Self::Forward,
        Self::Backward,
    ];

    /// Its name in CSV files.
    pub(super) fn as_str(self) -> &'static str {
        match self {
            Self::Extinction => "Qext",
            Self::Scattering => "Qsca",
            Self::Absorption => "Qabs",
            Self::Backscatter => "Qback",
            Self::Asymmetry => "g",
            Self::Forward => "S_0",
            Self::Backward => "S1_180",
        }
    }

    /// The relative error of what was found.
    fn error(self, found: &Optics, exact: &Optics) -> f64 {
        let amplitude = |s: Complex64, exact: Complex64| (s - exact).norm() / exact.norm();
        let relative = |q: f64, exact: f64| (q / exact - 1.0).abs();
        match self {
            Self::Extinction => relative(found.extinction, exact.extinction),
            Self::Scattering => relative(found.scattering, exact.scattering),
            Self::Absorption => relative(found.absorption, exact.absorption),
            Self::Backscatter => relative(found.backscatter, exact.backscatter),
            Self::Asymmetry => relative(found.asymmetry, exact.asymmetry),
            Self::Forward => amplitude(found.forward, exact.forward),
            Self::Backward => amplitude(found.backward, exact.backward),
        }
    }
}

/// Relative errors in the order of [`Quantity::ALL`].
#[derive(Debug, Clone, Copy)]
pub(super) struct Errors([f64; Quantity::ALL.len()]);

impl Errors {
    pub(super) fn of(&self, quantity: Quantity) -> f64 {
        self.0[quantity as usize]
    }
}

/// Variants that one figure shows.
#[derive(Debug, Clone)]
pub(super) struct Group {
    /// What its files are called.
    pub(super) name: &'static str,
    /// Heading of the figure.
    #[cfg_attr(not(feature = "plot"), expect(dead_code, reason = "the figure shows it"))]
    pub(super) title: &'static str,
    pub(super) variants: Vec<Variant>,
    /// What the rows of the figure show.
    #[cfg_attr(not(feature = "plot"), expect(dead_code, reason = "the figure shows them"))]
    pub(super) rows: Vec<Quantity>,
}

/// The groups, in the order of the figures.
pub(super) fn groups() -> Vec<Group> {
    use Quantity::{Absorption as Absorbed, Asymmetry, Backward, Extinction, Forward, Scattering};
    let variant = |key, title, method| Variant { key, title, method };
    let double = |key, title, recipe| variant(key, title, Method::Double(recipe));
    let single = |key, title, recipe: Recipe| {
        // What was scanned in single precision had the terms of Wiscombe.
        variant(key, title, Method::Single(Recipe { terms: Terms::Wiscombe, ..recipe }))
    };
    let limit = |key, title, limit| variant(key, title, Method::Limit(limit));
    let d = |derivative| Recipe { derivative, ..ROBUST };
    let psi = |radial| Recipe { radial, ..ROBUST };
    let terms = |terms| Recipe { terms, ..ROBUST };
    let wronskian = Recipe { absorption: Absorption::Wronskian, ..ROBUST };
    vec![
        Group {
            name: "upward",
            title: "Logarithmic derivative upwards from cot mx",
            variants: vec![
                double("up_squares", "cot by squares", d(Derivative::UpSquares)),
                double("up_exponential", "cot by an exponential", d(Derivative::UpExponential)),
                double("up_where_allowed", "where Wiscombe allows it", d(Derivative::UpWhereAllowed)),
            ],
            rows: vec![Extinction, Backward],
        },
        Group {
            name: "downward",
            title: "Logarithmic derivative downwards",
            variants: vec![
                double("down_from_largest", "from max(N, |mx|) + 16", d(Derivative::DownFromLargest)),
                double("down", "from |mx| + 8 |mx|^(1/3) + 16", d(Derivative::Down)),
                double("fraction", "from Lentz' fraction at N", d(Derivative::Fraction)),
            ],
            rows: vec![Extinction, Backward],
        },
        Group {
            name: "radial",
            title: "Riccati-Bessel function psi",
            variants: vec![
                double("psi_up", "upwards", psi(Radial::Up)),
                double("psi_down", "downwards", psi(Radial::Down)),
                double("psi_mixed", "upwards to n = x", psi(Radial::Mixed)),
            ],
            rows: vec![Scattering, Asymmetry],
        },
        Group {
            name: "terms",
            title: "Number of terms",
            variants: vec![
                double("terms_wiscombe", "Wiscombe", terms(Terms::Wiscombe)),
                double("terms_bohren_huffman", "x + 4x^(1/3) + 2", terms(Terms::BohrenHuffman)),
                double("terms_six", "x + 6x^(1/3) + 3", terms(Terms::Six)),
                double("terms_full", "x + 7.2x^(1/3) + 4", terms(Terms::Full)),
                double("terms_ten", "x + 10", terms(Terms::Ten)),
            ],
            rows: vec![Extinction, Backward],
        },
        Group {
            name: "single",
            title: "Single precision",
            variants: vec![
                single("single_down_psi_up", "D down, psi up", psi(Radial::Up)),
                single("single_down_psi_mixed", "D down, psi mixed", ROBUST),
                single("single_fraction_psi_mixed", "Lentz, psi mixed", d(Derivative::Fraction)),
                single(
                    "single_largest_psi_up",
                    "D from max, psi up",
                    Recipe { radial: Radial::Up, ..d(Derivative::DownFromLargest) },
                ),
                variant("single_ours", "Airlight's choices", Method::Single(OURS)),
            ],
            rows: vec![Extinction, Backward],
        },
        Group {
            name: "limits",
            title: "Limits of small, large and faint spheres (blank where not meant)",
            variants: vec![
                limit("rayleigh", "Rayleigh", Limit::Rayleigh),
                limit("three_terms", "three terms", Limit::ThreeTerms),
                limit("anomalous_diffraction", "anomalous diffraction", Limit::AnomalousDiffraction),
                limit("geometric", "Qext = 2", Limit::Geometric),
                limit("edge", "Qext = 2 and the edge", Limit::Edge),
                variant("ours", "Airlight's solver", Method::Ours),
            ],
            rows: vec![Extinction],
        },
        Group {
            name: "absorption",
            title: "Absorption (blank for clear spheres)",
            variants: vec![
                double("difference", "Qext − Qsca, double precision", ROBUST),
                double("wronskian", "Wronskian, double precision", wronskian),
                variant("single_difference", "Qext − Qsca, single precision", Method::Single(ROBUST)),
                variant("single_wronskian", "Wronskian, single precision", Method::Single(wronskian)),
            ],
            rows: vec![Absorbed],
        },
        Group {
            name: "ours",
            title: "Airlight's solver (no absorption by clear spheres)",
            variants: vec![variant("ours", "", Method::Ours)],
            // Radar backscatter is as the amplitude at 180 degrees.
            rows: vec![Extinction, Scattering, Absorbed, Asymmetry, Forward, Backward],
        },
    ]
}

/// What is compared over the spheres that reach to x = 1e6, where the ingredients tell that do not below.
pub(super) fn large() -> [Variant; 4] {
    let double = |key, title, recipe| Variant { key, title, method: Method::Double(recipe) };
    let exact = Recipe { angular: Angular::Wiscombe, ..ROBUST };
    [
        double("textbook_plain", "textbook's angular functions", ROBUST),
        double("wiscombe_plain", "Wiscombe's", exact),
        double("wiscombe_blocked", "Wiscombe's, sums in blocks", Recipe { sums: Sums::Blocked, ..exact }),
        Variant { key: "ours", title: "Airlight's solver", method: Method::Ours },
    ]
}
