//! Many spheres of one refractive index: their efficiencies, and weighted sums over them.

use super::angular::Matrix;
use super::instructions::{Vectors, Work};
use super::lanes::{self, INTERLEAVED, Orders, Scratch};
use super::sphere::is_matched;
use super::{AngularTable, Efficiencies, Instructions, LARGEST_INSIDE, MieError, RefractiveIndex, SIZE_PARAMETERS};
use super::{Solver, instructions, terms};
use std::f64::consts::PI;
use std::ops::Range;

/// Size parameter up to which spheres are solved in vectors; larger ones need more than the precision of a double
/// in places and are solved one by one, as are those of nearly the index of their surroundings.
pub const VECTORS_UP_TO: f64 = 2000.0;

/// Sums over spheres i with weights w_i. Cross-sections are in units of the square of the wave number's
/// inverse: multiply by (lambda / 2 pi)^2 for m^2.
#[derive(Debug, Clone, PartialEq)]
pub struct Sums {
    /// sum w_i pi x_i^2 Qext.
    pub extinction: f64,
    /// sum w_i pi x_i^2 Qsca.
    pub scattering: f64,
    /// sum w_i pi x_i^2 Qabs.
    pub absorption: f64,
    /// sum w_i pi x_i^2 Qsca g.
    pub forward: f64,
    /// sum w_i pi x_i^2 Qback.
    pub backscatter: f64,
    /// Elements of the scattering matrix at each angle (Bohren & Huffman 1983, equation 4.77): sum w_i times
    /// S11 = (|S1|^2 + |S2|^2) / 2, whose integral over the sphere is `scattering`, S12 = (|S2|^2 - |S1|^2) / 2,
    /// S33 = Re(S1 S2*), S34 = Im(S2 S1*).
    pub matrix: [Vec<f64>; 4],
}

impl Sums {
    /// Nothing summed yet, at `angles` angles.
    #[must_use]
    pub fn zero(angles: usize) -> Self {
        let matrix = std::array::from_fn(|_| vec![0.0; angles]);
        Self { extinction: 0.0, scattering: 0.0, absorption: 0.0, forward: 0.0, backscatter: 0.0, matrix }
    }

    /// S11 at each angle: the scattered intensity for natural light.
    #[must_use]
    pub fn intensity(&self) -> &[f64] {
        &self.matrix[0]
    }

    /// Adds `factor` times `other`, which has as many angles (further ones are left out).
    pub fn add(&mut self, other: &Self, factor: f64) {
        self.extinction += factor * other.extinction;
        self.scattering += factor * other.scattering;
        self.absorption += factor * other.absorption;
        self.forward += factor * other.forward;
        self.backscatter += factor * other.backscatter;
        for (sum, term) in self.matrix.iter_mut().flatten().zip(other.matrix.iter().flatten()) {
            *sum += factor * term;
        }
    }

    fn add_sphere(&mut self, x: f64, weight: f64, q: &Efficiencies) {
        let area = weight * PI * x * x;
        self.extinction += area * q.extinction;
        self.scattering += area * q.scattering;
        self.absorption += area * q.absorption;
        self.backscatter += area * q.backscatter;
        if q.scattering > 0.0 {
            self.forward += area * q.scattering * q.asymmetry;
        }
    }
}

/// Solves many spheres of one index at a time, as many at once as the instruction set has lanes, and keeps its
/// memory. Up to [`VECTORS_UP_TO`] the results of the instruction sets differ in their last digits; beyond, and for
/// an index near 1, all take the way of [`Solver`].
#[derive(Debug, Clone)]
pub struct Spheres {
    instructions: Instructions,
    single: Solver,
    orders: Orders,
    scratch: Scratch,
    matrix: Matrix,
    /// Sizes in rising order with their place in what was asked.
    sorted: Vec<(f64, usize)>,
    sizes: Vec<f64>,
    weights: Vec<f64>,
    solved: Vec<Efficiencies>,
}

impl Default for Spheres {
    fn default() -> Self {
        Self::new()
    }
}

impl Spheres {
    /// Solves with the best instruction set of this processor.
    #[must_use]
    pub fn new() -> Self {
        Self::with(Instructions::best())
    }

    /// Solves with a given instruction set, which must be one of [`Instructions::available`]; the plain one is taken
    /// for another.
    #[must_use]
    pub fn with(instructions: Instructions) -> Self {
        Self {
            instructions,
            single: Solver::new(),
            orders: Orders::default(),
            scratch: Scratch::default(),
            matrix: Matrix::default(),
            sorted: Vec::new(),
            sizes: Vec::new(),
            weights: Vec::new(),
            solved: Vec::new(),
        }
    }

    /// Efficiencies of spheres of index `m` and size parameters `x`, in their order.
    ///
    /// # Errors
    /// [`MieError`] of the first sphere that is out of range.
    pub fn efficiencies(&mut self, m: RefractiveIndex, x: &[f64]) -> Result<Vec<Efficiencies>, MieError> {
        let none = AngularTable::new(&[], 0)?;
        self.solve(m, x.iter().map(|&x| (x, 0.0)), &none)?;
        let mut result = vec![Efficiencies::NOTHING; x.len()];
        for (&(_, i), q) in self.sorted.iter().zip(&self.solved) {
            result[i] = *q;
        }
        Ok(result)
    }

    /// Sums over spheres of index `m` given as (size parameter, weight). With a table of no angles only the
    /// efficiencies are computed. After the largest sphere nothing is allocated but the result.
    ///
    /// # Errors
    /// [`MieError`] of the first sphere that is out of range, or [`MieError::Terms`] if the table is too small.
    pub fn sum(
        &mut self,
        m: RefractiveIndex,
        spheres: impl IntoIterator<Item = (f64, f64)>,
        angles: &AngularTable,
    ) -> Result<Sums, MieError> {
        self.solve(m, spheres, angles)?;
        let count = angles.cosines().len();
        let mut sums = Sums::zero(0);
        for ((&(x, _), &weight), q) in self.sorted.iter().zip(&self.weights).zip(&self.solved) {
            sums.add_sphere(x, weight, q);
        }
        sums.matrix = self.matrix.elements(count);
        Ok(sums)
    }

    /// Fills `sorted`, `weights` and `solved`, and `matrix` at the angles.
    fn solve(
        &mut self,
        m: RefractiveIndex,
        spheres: impl IntoIterator<Item = (f64, f64)>,
        angles: &AngularTable,
    ) -> Result<(), MieError> {
        self.sorted.clear();
        self.sizes.clear();
        self.sizes.extend(spheres.into_iter().enumerate().map(|(i, (x, weight))| {
            self.sorted.push((x, i));
            weight
        }));
        let inside = m.to_complex().norm();
        for &(x, _) in &self.sorted {
            if !(SIZE_PARAMETERS.0..=SIZE_PARAMETERS.1).contains(&x) {
                return Err(MieError::Size { x });
            }
            if inside * x > LARGEST_INSIDE {
                return Err(MieError::Inside { mx: inside * x });
            }
        }
        self.sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
        self.weights.clear();
        self.weights.extend(self.sorted.iter().map(|&(_, i)| self.sizes[i]));
        self.sizes.clear();
        self.sizes.extend(self.sorted.iter().map(|&(x, _)| x));
        self.solved.clear();
        self.matrix.clear(angles);
        let Some(&largest) = self.sizes.last() else { return Ok(()) };
        if !angles.cosines().is_empty() && terms(largest) > angles.terms() {
            return Err(MieError::Terms { needed: terms(largest), available: angles.terms() });
        }
        let matched = self.sizes.partition_point(|&x| m.is_one() || is_matched(m, x));
        let vectors = self.sizes.partition_point(|&x| x <= VECTORS_UP_TO).max(matched);
        self.one_by_one(m, 0..matched, angles)?;
        self.in_vectors(m, matched..vectors, angles);
        self.one_by_one(m, vectors..self.sizes.len(), angles)
    }

    /// Solves these of the sorted spheres in vectors.
    fn in_vectors(&mut self, m: RefractiveIndex, spheres: Range<usize>, angles: &AngularTable) {
        let (sizes, weights) = (&self.sizes[spheres.clone()], &self.weights[spheres]);
        let Some(&largest) = sizes.last() else { return };
        self.orders.reach(terms(largest) + 1);
        let (orders, scratch) = (&self.orders, &mut self.scratch);
        let (solved, matrix) = (&mut self.solved, &mut self.matrix);
        instructions::run(self.instructions, Job { m, sizes, weights, angles, orders, scratch, solved, matrix });
    }

    /// Solves these of the sorted spheres one by one; the sums over angles take them in vectors.
    fn one_by_one(&mut self, m: RefractiveIndex, spheres: Range<usize>, angles: &AngularTable) -> Result<(), MieError> {
        let (sizes, weights) = (&self.sizes[spheres.clone()], &self.weights[spheres]);
        let (single, scratch) = (&mut self.single, &mut self.scratch);
        let (solved, matrix) = (&mut self.solved, &mut self.matrix);
        instructions::run(self.instructions, Singles { m, sizes, weights, angles, single, scratch, solved, matrix })
    }
}

/// Spheres in rising order that are solved one by one.
struct Singles<'a> {
    m: RefractiveIndex,
    sizes: &'a [f64],
    weights: &'a [f64],
    angles: &'a AngularTable,
    single: &'a mut Solver,
    scratch: &'a mut Scratch,
    solved: &'a mut Vec<Efficiencies>,
    matrix: &'a mut Matrix,
}

impl Work for Singles<'_> {
    type Output = Result<(), MieError>;

    #[inline(always)]
    fn with<S: Vectors>(self, simd: S) -> Self::Output {
        let lanes = S::F64_LANES;
        for (sizes, weights) in self.sizes.chunks(lanes).zip(self.weights.chunks(lanes)) {
            let count = if self.angles.cosines().is_empty() { 0 } else { terms(sizes[sizes.len() - 1]) };
            let (plus, minus) = (&mut self.scratch.plus[0], &mut self.scratch.minus[0]);
            for values in [&mut *plus, &mut *minus] {
                values.clear();
                values.resize(2 * lanes * count, 0.0);
            }
            for (lane, &x) in sizes.iter().enumerate() {
                let sphere = self.single.sphere(self.m, x)?;
                self.solved.push(sphere.efficiencies());
                let orders = plus.chunks_exact_mut(2 * lanes).zip(minus.chunks_exact_mut(2 * lanes));
                for (i, ((plus, minus), (a, b))) in orders.zip(sphere.a().iter().zip(sphere.b())).enumerate() {
                    let n = (i + 1) as f64;
                    let factor = (2.0 * n + 1.0) / (n * (n + 1.0));
                    for (values, value) in [(plus, (a + b) * factor), (minus, (a - b) * factor)] {
                        (values[lane], values[lanes + lane]) = (value.re, value.im);
                    }
                }
            }
            if count > 0 {
                self.matrix.add(simd, self.angles, (plus, minus), count, weights);
            }
        }
        Ok(())
    }
}

/// Spheres in rising order that are solved in vectors.
struct Job<'a> {
    m: RefractiveIndex,
    sizes: &'a [f64],
    weights: &'a [f64],
    angles: &'a AngularTable,
    orders: &'a Orders,
    scratch: &'a mut Scratch,
    solved: &'a mut Vec<Efficiencies>,
    matrix: &'a mut Matrix,
}

impl Job<'_> {
    /// The spheres `from` on, up to `VECTORS` vectors of them; gives how many.
    #[inline(always)]
    fn group<S: Vectors, const VECTORS: usize>(&mut self, simd: S, from: usize) -> usize {
        let lanes = S::F64_LANES;
        let group = from..self.sizes.len().min(from + VECTORS * lanes);
        let keep = !self.angles.cosines().is_empty();
        let sizes = &self.sizes[group.clone()];
        let done = lanes::solve::<S, VECTORS>(simd, self.m, sizes, self.orders, self.scratch, keep);
        for (v, (count, totals)) in done.iter().enumerate() {
            let here = (v * lanes).min(sizes.len())..((v + 1) * lanes).min(sizes.len());
            for (lane, &x) in sizes[here.clone()].iter().enumerate() {
                let back = [totals.back[0][lane], totals.back[1][lane]];
                let (scattering, absorption) = (totals.scattering[lane], totals.absorption[lane]);
                self.solved.push(Efficiencies::from_sums(x, scattering, absorption, totals.cosine[lane], back));
            }
            if keep && !here.is_empty() {
                let coefficients = (self.scratch.plus[v].as_slice(), self.scratch.minus[v].as_slice());
                self.matrix.add(simd, self.angles, coefficients, *count, &self.weights[from..][here]);
            }
        }
        group.len()
    }
}

impl Work for Job<'_> {
    type Output = ();

    #[inline(always)]
    fn with<S: Vectors>(mut self, simd: S) {
        let mut from = 0;
        while from < self.sizes.len() {
            from += if self.sizes.len() - from > S::F64_LANES {
                self.group::<S, INTERLEAVED>(simd, from)
            } else {
                self.group::<S, 1>(simd, from)
            };
        }
    }
}
