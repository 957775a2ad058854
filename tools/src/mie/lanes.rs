//! Many spheres of one index at once: one sphere to a lane of a vector, and several vectors in turn, so that the
//! latency of one recurrence is hidden behind the others.
//!
//! The formulas are those of [`crate::mie`]; this file says only how they are laid out. Written once over
//! [`pulp::Simd`], compiled for each instruction set of [`Instructions`](super::Instructions).

use super::instructions::Vectors;
use super::{RefractiveIndex, sphere, terms};
use num_complex::Complex64;
use pulp::Simd;

/// Terms summed plainly before they are added to the total.
const BLOCK: usize = 128;

/// Most lanes that any instruction set has.
pub(super) const LANES: usize = 8;

/// Vectors whose ratios R_n are computed in turn: four hide the latency of a division.
pub(super) const INTERLEAVED: usize = 4;

/// Numbers for each order n that all spheres share: 2n + 1, (2n + 1) / (n (n + 1)), (n - 1)(n + 1) / n.
#[derive(Debug, Clone, Default)]
pub(super) struct Orders(Vec<[f64; 3]>);

impl Orders {
    /// Makes sure that the orders up to `last` are there.
    pub(super) fn reach(&mut self, last: usize) {
        for n in self.0.len()..=last {
            let n = n as f64;
            let odd = 2.0 * n + 1.0;
            self.0.push([odd, odd / (n * (n + 1.0)), (n - 1.0) * (n + 1.0) / n]);
        }
    }
}

/// Memory of one group of spheres.
#[derive(Debug, Clone, Default)]
pub(super) struct Scratch {
    /// Real and imaginary part of R_n(z), n = 0, 1, ..., of each vector in turn.
    inside: Vec<f64>,
    /// psi_n(x) / psi_(n-1)(x), n = 0, 1, ..., of each vector in turn.
    outside: Vec<f64>,
    /// Of each vector, for n = 1, 2, ...: real and imaginary part of (2n + 1) / (n (n + 1)) (a_n + b_n).
    pub(super) plus: [Vec<f64>; INTERLEAVED],
    /// The same with a_n - b_n.
    pub(super) minus: [Vec<f64>; INTERLEAVED],
}

/// Sums over the orders of up to [`LANES`] spheres.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Totals {
    /// sum (2n + 1) (|a_n|^2 + |b_n|^2).
    pub(super) scattering: [f64; LANES],
    /// The same of what is absorbed.
    pub(super) absorption: [f64; LANES],
    /// Half of g times the scattering.
    pub(super) cosine: [f64; LANES],
    /// Real and imaginary part of sum (2n + 1) (-1)^(n+1) (a_n - b_n).
    pub(super) back: [[f64; LANES]; 2],
}

/// A complex number in each lane.
#[derive(Clone, Copy)]
struct Complexes<S: Simd> {
    re: S::f64s,
    im: S::f64s,
}

impl<S: Simd> Complexes<S> {
    #[inline(always)]
    fn splat(simd: S, value: Complex64) -> Self {
        Self { re: simd.splat_f64s(value.re), im: simd.splat_f64s(value.im) }
    }

    /// Re(self other*) + add.
    #[inline(always)]
    fn dot_add(self, simd: S, other: Self, add: S::f64s) -> S::f64s {
        simd.mul_add_e_f64s(self.re, other.re, simd.mul_add_e_f64s(self.im, other.im, add))
    }
}

/// Loads `lanes` from a slice of as many numbers.
#[inline(always)]
fn load<S: Simd>(lanes: &[f64; LANES]) -> S::f64s {
    S::as_simd_f64s(lanes).0[0]
}

/// The first lanes of `LANES`.
#[inline(always)]
fn store<S: Simd>(vector: S::f64s, lanes: &mut [f64; LANES]) {
    S::as_mut_simd_f64s(lanes).0[0] = vector;
}

/// The coefficients of up to `VECTORS` times as many spheres as a vector has lanes, of index `m` and sizes `x`, which
/// do not fall. Missing spheres are taken as more of the last. With `keep`, fills [`Scratch::plus`] and
/// [`Scratch::minus`] of each vector up to the number of terms that is returned.
#[inline(always)]
pub(super) fn solve<S: Vectors, const VECTORS: usize>(
    simd: S,
    m: RefractiveIndex,
    x: &[f64],
    orders: &Orders,
    scratch: &mut Scratch,
    keep: bool,
) -> [(usize, Totals); VECTORS] {
    let lanes = S::F64_LANES;
    let size = |i: usize| x[i.min(x.len() - 1)];
    let mut sizes = [[0.0; LANES]; VECTORS];
    for (v, sizes) in sizes.iter_mut().enumerate() {
        for (lane, one) in sizes.iter_mut().enumerate().take(lanes) {
            *one = size(v * lanes + lane);
        }
    }
    let largest = x[x.len() - 1];
    let last = terms(largest) + 1;
    inside::<S, VECTORS>(simd, m, &sizes, largest, last, &mut scratch.inside);
    outside::<S, VECTORS>(simd, &sizes, largest, last, &mut scratch.outside);
    let mut result = [(0, Totals::default()); VECTORS];
    for v in 0..VECTORS {
        let count = terms(size((v + 1) * lanes - 1));
        let ratios = Ratios::<S> {
            inside: S::as_simd_f64s(&scratch.inside).0,
            outside: S::as_simd_f64s(&scratch.outside).0,
            vectors: VECTORS,
            vector: v,
        };
        let (plus, minus) = (&mut scratch.plus[v], &mut scratch.minus[v]);
        let stored = if keep { 2 * lanes * count } else { 0 };
        plus.resize(stored, 0.0);
        minus.resize(stored, 0.0);
        let kept = (S::as_mut_simd_f64s(plus).0, S::as_mut_simd_f64s(minus).0);
        result[v] = (count, coefficients(simd, m, &sizes[v], count, &orders.0, &ratios, kept));
    }
    result
}

/// R_n(z) of each vector for n = 1 ..= `last`, downwards.
#[inline(always)]
fn inside<S: Vectors, const VECTORS: usize>(
    simd: S,
    m: RefractiveIndex,
    sizes: &[[f64; LANES]; VECTORS],
    largest: f64,
    last: usize,
    out: &mut Vec<f64>,
) {
    let width = 2 * VECTORS;
    out.resize((last + 1) * width * S::F64_LANES, 0.0);
    let out = S::as_mut_simd_f64s(out).0;
    let start = super::recurrence::start((m.to_complex() * largest).norm(), last);
    let inverse = m.to_complex().inv();
    let zero = simd.splat_f64s(0.0);
    let mut inverses = [Complexes::<S> { re: zero, im: zero }; VECTORS];
    for (one, sizes) in inverses.iter_mut().zip(sizes) {
        let x = load::<S>(sizes);
        one.re = simd.div_f64s(simd.splat_f64s(inverse.re), x);
        one.im = simd.div_f64s(simd.splat_f64s(inverse.im), x);
    }
    let mut ratios = [Complexes::<S> { re: zero, im: zero }; VECTORS];
    for n in (last + 1..=start).rev() {
        step_inside(simd, n, &inverses, &mut ratios);
    }
    for n in (1..=last).rev() {
        step_inside(simd, n, &inverses, &mut ratios);
        let row = &mut out[n * width..(n + 1) * width];
        for v in 0..VECTORS {
            row[2 * v] = ratios[v].re;
            row[2 * v + 1] = ratios[v].im;
        }
    }
}

/// From R_(n+1) to R_n = 1 / w, w = (2n + 1)/z - R_(n+1).
#[inline(always)]
fn step_inside<S: Vectors, const VECTORS: usize>(
    simd: S,
    n: usize,
    inverses: &[Complexes<S>; VECTORS],
    ratios: &mut [Complexes<S>; VECTORS],
) {
    let odd = simd.splat_f64s((2 * n + 1) as f64);
    // A zero of w gives a number so large that the next step forgets it.
    let never = simd.splat_f64s(1e-150);
    for v in 0..VECTORS {
        let re = simd.add_f64s(simd.mul_sub(odd, inverses[v].re, ratios[v].re), never);
        // Of -w, so that no sign needs to change.
        let im = simd.sub_mul(ratios[v].im, odd, inverses[v].im);
        let weight = simd.reciprocal(simd.mul_add_e_f64s(re, re, simd.mul_f64s(im, im)));
        ratios[v] = Complexes { re: simd.mul_f64s(re, weight), im: simd.mul_f64s(im, weight) };
    }
}

/// psi_n(x) / psi_(n-1)(x) of each vector, from the lowest n that a sphere needs up to `last`, downwards.
#[inline(always)]
fn outside<S: Vectors, const VECTORS: usize>(
    simd: S,
    sizes: &[[f64; LANES]; VECTORS],
    largest: f64,
    last: usize,
    out: &mut Vec<f64>,
) {
    out.resize((last + 1) * VECTORS * S::F64_LANES, 0.0);
    let out = S::as_mut_simd_f64s(out).0;
    let one = simd.splat_f64s(1.0);
    let mut inverses = [one; VECTORS];
    for (inverse, sizes) in inverses.iter_mut().zip(sizes) {
        *inverse = simd.div_f64s(one, load::<S>(sizes));
    }
    let mut ratios = [simd.splat_f64s(0.0); VECTORS];
    for n in (last + 1..=super::recurrence::start_outside(largest, last)).rev() {
        step_outside(simd, n, &inverses, &mut ratios);
    }
    let lowest = super::recurrence::upward_to(sizes[0][0], last);
    for n in (lowest + 1..=last).rev() {
        step_outside(simd, n, &inverses, &mut ratios);
        out[n * VECTORS..(n + 1) * VECTORS].copy_from_slice(&ratios);
    }
}

/// From psi_(n+1) / psi_n to psi_n / psi_(n-1) = 1 / ((2n + 1)/x - psi_(n+1) / psi_n).
#[inline(always)]
fn step_outside<S: Vectors, const VECTORS: usize>(
    simd: S,
    n: usize,
    inverses: &[S::f64s; VECTORS],
    ratios: &mut [S::f64s; VECTORS],
) {
    let odd = simd.splat_f64s((2 * n + 1) as f64);
    for v in 0..VECTORS {
        ratios[v] = simd.reciprocal(simd.mul_sub(odd, inverses[v], ratios[v]));
    }
}

/// What [`inside`] and [`outside`] found for one vector.
struct Ratios<'a, S: Simd> {
    inside: &'a [S::f64s],
    outside: &'a [S::f64s],
    vectors: usize,
    vector: usize,
}

/// What goes from one order to the next.
#[derive(Clone, Copy)]
struct State<S: Simd> {
    /// psi_(n-1) and psi_n.
    psi: [S::f64s; 2],
    /// chi_(n-1) and chi_n.
    chi: [S::f64s; 2],
    a: Complexes<S>,
    b: Complexes<S>,
}

/// What all orders of a vector share.
struct Shared<S: Simd> {
    inverse_x: S::f64s,
    /// Order up to which psi goes upwards, and number of terms.
    upward: S::f64s,
    count: S::f64s,
    minus_index: Complexes<S>,
    inverse_index: Complexes<S>,
    /// (1/m^2 - 1) / x.
    contrast: Complexes<S>,
}

/// Sums of one block of orders.
#[derive(Clone, Copy)]
struct Accumulated<S: Simd> {
    scattering: S::f64s,
    absorption: S::f64s,
    cosine: S::f64s,
    back: Complexes<S>,
}

/// a_n and b_n of one vector for n = 1 ..= `count`, and their sums.
#[inline(always)]
fn coefficients<S: Vectors>(
    simd: S,
    m: RefractiveIndex,
    sizes: &[f64; LANES],
    count: usize,
    orders: &[[f64; 3]],
    ratios: &Ratios<'_, S>,
    (plus, minus): (&mut [S::f64s], &mut [S::f64s]),
) -> Totals {
    let lanes = S::F64_LANES;
    let upward = |x: f64| super::recurrence::upward_to(x, count + 1);
    let (mut last_upward, mut counts) = ([0.0; LANES], [0.0; LANES]);
    for (lane, &x) in sizes[..lanes].iter().enumerate() {
        (last_upward[lane], counts[lane]) = (upward(x) as f64, terms(x) as f64);
    }
    let zero = simd.splat_f64s(0.0);
    let nothing = Complexes { re: zero, im: zero };
    let inverse_x = simd.div_f64s(simd.splat_f64s(1.0), load::<S>(sizes));
    let contrast = sphere::contrast(m);
    let shared = Shared {
        inverse_x,
        upward: load::<S>(&last_upward),
        count: load::<S>(&counts),
        minus_index: Complexes::splat(simd, -m.to_complex()),
        inverse_index: Complexes::splat(simd, m.to_complex().inv()),
        contrast: Complexes {
            re: simd.mul_f64s(simd.splat_f64s(contrast.re), inverse_x),
            im: simd.mul_f64s(simd.splat_f64s(contrast.im), inverse_x),
        },
    };
    let first = ratios.outside.get(ratios.vectors + ratios.vector).copied().unwrap_or(zero);
    let mut ratio = [0.0; LANES];
    store::<S>(first, &mut ratio);
    let mut start = [[0.0; LANES]; 4];
    for (lane, &x) in sizes[..lanes].iter().enumerate() {
        let (sin, cos) = x.sin_cos();
        let psi = if upward(x) >= 1 { sin / x - cos } else { ratio[lane] * sin };
        for (value, lanes) in [sin, psi, cos, cos / x + sin].into_iter().zip(&mut start) {
            lanes[lane] = value;
        }
    }
    let mut state = State::<S> {
        psi: [load::<S>(&start[0]), load::<S>(&start[1])],
        chi: [load::<S>(&start[2]), load::<S>(&start[3])],
        a: nothing,
        b: nothing,
    };
    let empty = Accumulated { scattering: zero, absorption: zero, cosine: zero, back: nothing };
    let mut total = empty;
    // Up to here every sphere goes upwards and none has ended.
    let plain = (upward(sizes[0]).saturating_sub(1)).min(terms(sizes[0]));
    let keep = !plus.is_empty();
    let mut from = 1;
    while from <= count {
        let to = if from <= plain { plain.min(from + BLOCK - 1) } else { count.min(from + BLOCK - 1) };
        let mut sum = empty;
        for n in from..=to {
            let order = &orders[n];
            if to <= plain {
                state = advance::<S, false>(simd, n, order, &shared, ratios, state, &mut sum);
            } else {
                state = advance::<S, true>(simd, n, order, &shared, ratios, state, &mut sum);
            }
            if keep {
                let weight = simd.splat_f64s(order[1]);
                let State { a, b, .. } = state;
                plus[2 * n - 2] = simd.mul_f64s(weight, simd.add_f64s(a.re, b.re));
                plus[2 * n - 1] = simd.mul_f64s(weight, simd.add_f64s(a.im, b.im));
                minus[2 * n - 2] = simd.mul_f64s(weight, simd.sub_f64s(a.re, b.re));
                minus[2 * n - 1] = simd.mul_f64s(weight, simd.sub_f64s(a.im, b.im));
            }
        }
        total.scattering = simd.add_f64s(total.scattering, sum.scattering);
        total.absorption = simd.add_f64s(total.absorption, sum.absorption);
        total.cosine = simd.add_f64s(total.cosine, sum.cosine);
        total.back.re = simd.add_f64s(total.back.re, sum.back.re);
        total.back.im = simd.add_f64s(total.back.im, sum.back.im);
        from = to + 1;
    }
    let mut result = Totals::default();
    store::<S>(total.scattering, &mut result.scattering);
    store::<S>(total.absorption, &mut result.absorption);
    store::<S>(total.cosine, &mut result.cosine);
    store::<S>(total.back.re, &mut result.back[0]);
    store::<S>(total.back.im, &mut result.back[1]);
    result
}

/// The order n. `MIXED` where some spheres have gone over to ratios, or have ended.
#[inline(always)]
fn advance<S: Vectors, const MIXED: bool>(
    simd: S,
    n: usize,
    order: &[f64; 3],
    shared: &Shared<S>,
    ratios: &Ratios<'_, S>,
    state: State<S>,
    sum: &mut Accumulated<S>,
) -> State<S> {
    let at = (n + 1) * ratios.vectors + ratios.vector;
    let inside = Complexes::<S> { re: ratios.inside[2 * at], im: ratios.inside[2 * at + 1] };
    let odd = simd.splat_f64s(order[0]);
    let step = simd.mul_f64s(odd, shared.inverse_x);
    let (psi, chi) = (state.psi[1], state.chi[1]);
    let mut next_psi = simd.mul_sub(step, psi, state.psi[0]);
    if MIXED {
        let upward = simd.less_than_or_equal_f64s(simd.splat_f64s((n + 1) as f64), shared.upward);
        next_psi = simd.select_f64s(upward, next_psi, simd.mul_f64s(ratios.outside[at], psi));
    }
    let next_chi = simd.mul_sub(step, chi, state.chi[0]);

    let next = simd.splat_f64s((n + 1) as f64);
    let (c, minus, inverse) = (shared.contrast, shared.minus_index, shared.inverse_index);
    // C of a_n: (n + 1) / x (1/m^2 - 1) - R_(n+1) / m.
    let [re, im] = [simd.mul_f64s(next, c.re), simd.mul_f64s(next, c.im)];
    let of_a = Complexes::<S> {
        re: simd.sub_mul(simd.mul_add_e_f64s(inverse.im, inside.im, re), inverse.re, inside.re),
        im: simd.sub_mul(simd.sub_mul(im, inverse.re, inside.im), inverse.im, inside.re),
    };
    // C of b_n: -m R_(n+1).
    let of_b = Complexes::<S> {
        re: simd.mul_sub(minus.re, inside.re, simd.mul_f64s(minus.im, inside.im)),
        im: simd.mul_add_e_f64s(minus.re, inside.im, simd.mul_f64s(minus.im, inside.re)),
    };
    let (above_a, below_a, square_a) = fraction(simd, of_a, [psi, next_psi], [chi, next_chi]);
    let (above_b, below_b, square_b) = fraction(simd, of_b, [psi, next_psi], [chi, next_chi]);
    // One division for both.
    let both = simd.reciprocal(simd.mul_f64s(square_a, square_b));
    let (mut a, scattered_a, lost_a) = finish(simd, of_a, above_a, below_a, simd.mul_f64s(both, square_b));
    let (mut b, scattered_b, lost_b) = finish(simd, of_b, above_b, below_b, simd.mul_f64s(both, square_a));
    let mut scattered = simd.add_f64s(scattered_a, scattered_b);
    let mut lost = simd.add_f64s(lost_a, lost_b);
    if MIXED {
        let there = simd.less_than_or_equal_f64s(simd.splat_f64s(n as f64), shared.count);
        let zero = simd.splat_f64s(0.0);
        for value in [&mut a.re, &mut a.im, &mut b.re, &mut b.im, &mut scattered, &mut lost] {
            *value = simd.select_f64s(there, *value, zero);
        }
    }
    sum.scattering = simd.mul_add_e_f64s(odd, scattered, sum.scattering);
    sum.absorption = simd.sub_mul(sum.absorption, odd, lost);
    let zero = simd.splat_f64s(0.0);
    let same = a.dot_add(simd, b, zero);
    let neighbours = state.a.dot_add(simd, a, state.b.dot_add(simd, b, zero));
    sum.cosine = simd.mul_add_e_f64s(simd.splat_f64s(order[1]), same, sum.cosine);
    sum.cosine = simd.mul_add_e_f64s(simd.splat_f64s(order[2]), neighbours, sum.cosine);
    let signed = simd.splat_f64s(if n % 2 == 1 { order[0] } else { -order[0] });
    sum.back.re = simd.mul_add_e_f64s(signed, simd.sub_f64s(a.re, b.re), sum.back.re);
    sum.back.im = simd.mul_add_e_f64s(signed, simd.sub_f64s(a.im, b.im), sum.back.im);
    State { psi: [psi, next_psi], chi: [chi, next_chi], a, b }
}

/// Of a coefficient with this C: p = C psi_n + psi_(n+1), C xi_n + xi_(n+1), and the square of the latter.
#[inline(always)]
fn fraction<S: Vectors>(
    simd: S,
    c: Complexes<S>,
    psi: [S::f64s; 2],
    chi: [S::f64s; 2],
) -> (Complexes<S>, Complexes<S>, S::f64s) {
    let above = Complexes { re: simd.mul_add_e_f64s(c.re, psi[0], psi[1]), im: simd.mul_f64s(c.im, psi[0]) };
    let below = Complexes {
        re: simd.mul_add_e_f64s(c.im, chi[0], above.re),
        im: simd.sub_f64s(above.im, simd.mul_add_e_f64s(c.re, chi[0], chi[1])),
    };
    (above, below, simd.mul_add_e_f64s(below.re, below.re, simd.mul_f64s(below.im, below.im)))
}

/// The coefficient, its square, and the negative of its absorbed part, with one over the square of what is below.
#[inline(always)]
fn finish<S: Vectors>(
    simd: S,
    c: Complexes<S>,
    above: Complexes<S>,
    below: Complexes<S>,
    weight: S::f64s,
) -> (Complexes<S>, S::f64s, S::f64s) {
    let square = simd.mul_add_e_f64s(above.re, above.re, simd.mul_f64s(above.im, above.im));
    let scattered = simd.mul_f64s(square, weight);
    let lost = simd.mul_f64s(c.im, weight);
    let im = simd.mul_sub(above.im, below.re, simd.mul_f64s(above.re, below.im));
    let coefficient = Complexes { re: simd.sub_f64s(scattered, lost), im: simd.mul_f64s(im, weight) };
    (coefficient, scattered, lost)
}
