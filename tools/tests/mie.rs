//! The Mie solver against published values, arbitrary precision and another program.
#![allow(clippy::print_stdout, reason = "the figures found: cargo test -- --nocapture shows them")]

use num_complex::Complex64;
use scatrs::mie::{AmplitudeBuffers, Mie, MieOptions};
use tools::mie::{RefractiveIndex, Solver};

/// Size parameter, n, k, Qext (where printed), Qsca, g: test cases 5 to 19 of MIEV0 (Wiscombe, NCAR/TN-140+STR, 1979, and the
/// output distributed with the program), as quoted in the tests of miepython (GitHub scottprahl/miepython 0896cd3e).
const MIEV0: [(f64, f64, f64, Option<f64>, f64, f64); 15] = [
    (0.099, 0.75, 0.0, None, 0.000007, 0.001448),
    (0.101, 0.75, 0.0, None, 0.000008, 0.001507),
    (10.0, 0.75, 0.0, None, 2.232265, 0.896473),
    (1000.0, 0.75, 0.0, None, 1.997908, 0.844944),
    (1.0, 1.33, 1e-5, None, 0.093923, 0.184517),
    (100.0, 1.33, 1e-5, None, 2.096594, 0.868959),
    (10000.0, 1.33, 1e-5, None, 1.723857, 0.907840),
    (0.055, 1.5, 1.0, Some(0.101491), 0.000011, 0.000491),
    (0.056, 1.5, 1.0, Some(0.103347), 0.000012, 0.000509),
    (1.0, 1.5, 1.0, None, 0.663454, 0.192136),
    (100.0, 1.5, 1.0, Some(2.097502), 1.283697, 0.850252),
    (10000.0, 1.5, 1.0, Some(2.004368), 1.236575, 0.846309),
    (1.0, 10.0, 10.0, None, 2.049405, -0.110664),
    (100.0, 10.0, 10.0, None, 1.836785, 0.556215),
    (10000.0, 10.0, 10.0, None, 1.795393, 0.548194),
];

/// S1 and S2 of test case 14 of MIEV0 (x = 1, m = 1.5 - i) at 0, 30, ... 180 degrees, from the same source.
const MIEV0_AMPLITUDES: [[f64; 4]; 7] = [
    [0.584080, 0.190515, 0.584080, 0.190515],
    [0.565702, 0.187200, 0.500161, 0.145611],
    [0.517525, 0.178443, 0.287964, 0.041054],
    [0.456340, 0.167167, 0.0362285, -0.0618265],
    [0.400212, 0.156643, -0.174875, -0.122959],
    [0.362157, 0.149391, -0.305682, -0.143846],
    [0.348844, 0.146829, -0.348844, -0.146829],
];

/// S1 at 180 degrees of the cases 5 to 8 (m = 0.75).
const MIEV0_BACKWARD: [(f64, f64, f64); 4] = [
    (0.099, 1.81756e-8, -1.64810e-4),
    (0.101, 2.04875e-8, -1.74965e-4),
    (10.0, -1.07857, -3.60881e-2),
    (1000.0, 17.0578, 484.251),
];

fn index(n: f64, k: f64) -> RefractiveIndex {
    RefractiveIndex::new(n, k).expect("a refractive index")
}

#[test]
fn published_efficiencies_of_miev0_are_reproduced() {
    let mut solver = Solver::new();
    for (x, n, k, extinction, scattering, asymmetry) in MIEV0 {
        let q = solver.sphere(index(n, k), x).expect("in range").efficiencies();
        // Six decimals are printed.
        let close = |found: f64, printed: f64| (found - printed).abs() < 1e-6;
        let sound = close(q.scattering, scattering) && close(q.asymmetry, asymmetry);
        assert!(sound && extinction.is_none_or(|e| close(q.extinction, e)), "x = {x}, m = {n} + {k}i: {q:?}");
    }
}

#[test]
fn published_amplitudes_of_miev0_are_reproduced() {
    let mut solver = Solver::new();
    let sphere = solver.sphere(index(1.5, 1.0), 1.0).expect("in range");
    for (i, printed) in MIEV0_AMPLITUDES.into_iter().enumerate() {
        let s = sphere.amplitudes((30.0 * i as f64).to_radians().cos()).expect("a cosine");
        // MIEV0 has the conjugates, to six decimals.
        for (found, printed) in [s.s1.re, -s.s1.im, s.s2.re, -s.s2.im].into_iter().zip(printed) {
            assert!((found - printed).abs() < 1e-6, "{} degrees: {found}, {printed}", 30 * i);
        }
    }
    for (x, re, im) in MIEV0_BACKWARD {
        let s = solver.sphere(index(0.75, 0.0), x).expect("in range").amplitudes(-1.0).expect("a cosine").s1.conj();
        // Six digits are printed.
        let difference = (s - Complex64::new(re, im)).norm();
        assert!(difference < 5e-6 * s.norm(), "x = {x}: {s}, printed {re} + {im}i");
    }
}

#[test]
fn spheres_agree_with_arbitrary_precision() {
    /// Half the distance of doubles from 1 on.
    const EPSILON: f64 = 1.1e-16;
    let text =
        std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/reference/spheres.csv")).expect("read");
    let mut reader = csv::ReaderBuilder::new().comment(Some(b'#')).from_reader(text.as_bytes());
    let headers = reader.headers().expect("a header").clone();
    let angles = [("0", 1.0), ("30", 0.75_f64.sqrt()), ("90", 0.0), ("150", -0.75_f64.sqrt()), ("180", -1.0)];
    let mut solver = Solver::new();
    let (mut count, mut worst, mut share, mut share_of_amplitudes) = (0, 0.0_f64, 0.0_f64, 0.0_f64);
    for record in reader.records() {
        let record = record.expect("a row");
        let value = |name: &str| -> f64 {
            let column = headers.iter().position(|h| h == name).expect("a column");
            record[column].parse().expect("a number")
        };
        let (x, n, k) = (value("x"), value("m_re"), -value("m_im"));
        let sphere = solver.sphere(index(n, k), x).expect("in range");
        let q = sphere.efficiencies();
        for (name, found) in [
            ("Qext", q.extinction),
            ("Qsca", q.scattering),
            ("Qabs", q.absorption),
            ("Qback", q.backscatter),
            ("g", q.asymmetry),
        ] {
            let expected = value(name);
            if expected == 0.0 {
                assert!(found.abs() <= 50.0 * EPSILON * q.extinction, "x = {x}, m = {n} + {k}i: {name} {found}, not 0");
                continue;
            }
            let error = (found / expected - 1.0).abs();
            worst = worst.max(error);
            // Twenty times what the last digits of x and m are worth, and not less than what a double with a sum of many
            // terms holds: 1e-13, in the backward amplitude and in sums of more than 2e5 terms 1e-11.
            let least = if name == "Qback" || x > 2e5 { 1e-11 } else { 1e-13 };
            let tolerance = (20.0 * value(&format!("kappa_{name}")) * EPSILON).max(least);
            share = share.max(error / tolerance);
            assert!(error <= tolerance, "x = {x}, m = {n} + {k}i: {name} {found}, {expected}: {error} > {tolerance}");
        }
        for (angle, cosine) in angles {
            let s = sphere.amplitudes(cosine).expect("a cosine");
            let part = |p: u8| Complex64::new(value(&format!("S{p}_{angle}_re")), -value(&format!("S{p}_{angle}_im")));
            let (s1, s2) = (part(1), part(2));
            let error = (s.s1 - s1).norm().max((s.s2 - s2).norm());
            // The same for sums whose terms cancel.
            let size = s1.norm().max(s2.norm());
            let tolerance =
                EPSILON * (50.0 * value(&format!("scale_{angle}")) + 20.0 * value(&format!("kS_{angle}")) * size);
            share_of_amplitudes = share_of_amplitudes.max(error / tolerance);
            assert!(error <= tolerance, "x = {x}, m = {n} + {k}i, {angle} degrees: {error} > {tolerance}");
        }
        count += 1;
    }
    println!(
        "{count} spheres: largest relative error of Q and g {worst:.1e}; at most {share:.2} of what is allowed in Q and g, \
         {share_of_amplitudes:.2} in amplitudes"
    );
    assert_eq!(count, 45);
}

#[test]
fn another_program_agrees() {
    let mut ours = Solver::new();
    let mut theirs = Mie::<f64>::new();
    let cosines = [-1.0, -0.5, 0.0, 0.7, 1.0];
    for (n, k) in [(1.33, 1e-8), (1.53, 0.008), (1.75, 0.44), (1.1, 0.0), (2.5, 1.0)] {
        for i in 0..25 {
            let x = 0.01 * 1.6_f64.powi(i);
            let (sphere, other) = (
                ours.sphere(index(n, k), x).expect("in range"),
                theirs.compute(x, Complex64::new(n, k), &MieOptions::new()).expect("in its range"),
            );
            let (q, p) = (sphere.efficiencies(), other.efficiencies());
            for (found, expected) in [(q.extinction, p.q_ext), (q.scattering, p.q_sca), (q.asymmetry, p.g)] {
                // What the worse of two programs in double precision may lose on spheres without narrow resonances.
                assert!((found - expected).abs() < 1e-9 * expected.abs(), "{n} + {k}i, {x}: {found}, {expected}");
            }
            let (mut s1, mut s2) = ([Complex64::ZERO; 5], [Complex64::ZERO; 5]);
            other.amplitudes(&cosines, AmplitudeBuffers { s1: &mut s1, s2: &mut s2 }).expect("cosines");
            for (i, cosine) in cosines.into_iter().enumerate() {
                let s = sphere.amplitudes(cosine).expect("a cosine");
                let difference = (s.s1 - s1[i]).norm().max((s.s2 - s2[i]).norm());
                assert!(
                    difference < 1e-8 * s1[i].norm().max(s2[i].norm()),
                    "{n} + {k}i, {x}, {cosine}: {s:?}, {}, {}",
                    s1[i],
                    s2[i]
                );
            }
        }
    }
}
