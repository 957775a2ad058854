//! How well the errors agree with those that an independent program found for the same variants.

use super::reference::{Scan, Sphere};
use super::variants::{Errors, Quantity, Variant};

/// Errors up to this one, from rounding alone, are not compared.
const ROUNDING: f64 = 1e-12;

/// Cells of the map of one variant or of several: a quantity of a sphere each.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Agreement {
    /// Cells where the other program found an error above 1e-12.
    pub(super) cells: usize,
    /// Those in which ours is within a decade of it, or neither is a number.
    pub(super) agreeing: usize,
    /// Cells where the other program found 1e-12 or less.
    pub(super) small: usize,
    /// Those in which ours is more than a decade above 1e-12.
    pub(super) exceeding: usize,
}

impl Agreement {
    /// Of one variant, whose errors are those of the spheres in order; `None` for one that was not scanned.
    pub(super) fn of(variant: &Variant, errors: &[Errors], spheres: &[Sphere], scan: &Scan) -> Option<Self> {
        let mut agreement = Self::default();
        // Absorption was not scanned.
        let scanned = |q: &Quantity| variant.has(*q) && *q != Quantity::Absorption;
        for (sphere, errors) in spheres.iter().zip(errors) {
            for quantity in Quantity::ALL.into_iter().filter(scanned) {
                let ours = errors.of(quantity);
                if let Some(theirs) = scan.error(variant.key, quantity, sphere) {
                    agreement.cells += 1;
                    agreement.agreeing += usize::from(agree(ours, theirs));
                } else if !ours.is_nan() {
                    agreement.small += 1;
                    agreement.exceeding += usize::from(ours > 10.0 * ROUNDING);
                }
            }
        }
        (agreement.cells > 0).then_some(agreement)
    }

    /// The cells of both.
    pub(super) fn with(self, other: Self) -> Self {
        Self {
            cells: self.cells + other.cells,
            agreeing: self.agreeing + other.agreeing,
            small: self.small + other.small,
            exceeding: self.exceeding + other.exceeding,
        }
    }

    /// Agreeing cells over all.
    pub(super) fn share(self) -> f64 {
        self.agreeing as f64 / self.cells as f64
    }
}

/// Whether two errors are within a factor of ten, or neither is a number.
fn agree(ours: f64, theirs: f64) -> bool {
    if theirs.is_finite() { (ours / theirs).log10().abs() <= 1.0 } else { ours.is_infinite() }
}
