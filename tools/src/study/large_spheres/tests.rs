use super::*;

fn index(wavelength_nm: u32) -> RefractiveIndex {
    let raw = Path::new(env!("CARGO_MANIFEST_DIR")).join("../raw-data");
    Index::read(&raw).expect("sound").at(wavelength_nm).expect("inside")
}

/// Drops at 550 nm and their angles: some around each of these ranges, by this step.
fn solved(sizes: Gamma, ranges: &[(f64, f64, f64)], step: f64) -> (Solved, Vec<f64>) {
    let mut degrees = Vec::new();
    for &(from, to, by) in ranges {
        degrees.extend((0..=((to - from) / by) as u32).map(|i| from + f64::from(i) * by));
    }
    let (wavelength_nm, index) = (550, index(550));
    let angles = drops::table(&degrees, sizes, 550e-9).expect("angles");
    let averaged = average(index, sizes, 550e-9, &angles, step).expect("in range");
    (Solved { kind: "test", wavelength_nm, sizes, index, averaged }, degrees)
}

#[test]
fn rainbows_are_where_airy_puts_them() {
    // Every third step of the study: the main maxima are smooth.
    let (drops, degrees) = solved(DROP_SIZES, &[(125.5, 129.5, 0.1), (137.5, 140.0, 0.05)], 3.0 * DROP_STEP);
    // Airy's theory leaves out what the amplitude and the wavefront do to the next order, x^(-2/3) = 0.005 of the shift
    // from Descartes' angle (0.5 and 0.9, with the supernumeraries 1.6 and 2.8 degrees) times numbers of the order of
    // one for the primary bow, and of ten for the stronger cubic of the secondary.
    for (kind, maximum, tolerance) in
        [(Bow::Primary, 0, 0.02), (Bow::Primary, 1, 0.03), (Bow::Secondary, 0, 0.06), (Bow::Secondary, 1, 0.06)]
    {
        let found = bow(&drops, &drops.averaged.phase, &degrees, kind, maximum);
        let mie = found.mie_deg.expect("a maximum");
        assert!((mie - found.airy_deg).abs() < tolerance, "{kind:?} {maximum}: {mie}, {}", found.airy_deg);
        // Far more than the tolerance from where rays alone would put it.
        assert!((mie - found.descartes_deg).abs() > 0.4, "{kind:?} {maximum}: {mie}, {}", found.descartes_deg);
    }
}

#[test]
fn a_narrow_cloud_has_the_dark_ring_of_a_disc_and_a_glory_that_scales() {
    let of = |radius: f64| {
        let sizes = Gamma { radius, variance: 0.01 };
        let scale = 10e-6 / radius;
        let ranges = [(1.0 * scale, 3.0 * scale, 0.02 * scale), (180.0 - 3.0 * scale, 180.0, 0.02 * scale)];
        let (cloud, degrees) = solved(sizes, &ranges, CLOUD_STEP);
        let found = rings(&cloud, &degrees);
        (found.corona_deg.expect("a ring"), found.disc_deg, found.glory_abscissa)
    };
    let (small, large) = (of(10e-6), of(20e-6));
    for (corona, disc, _) in [small, large] {
        // Light that goes through the drops interferes with what is diffracted: corrections of the order of x^(-2/3),
        // 4 % for x = 114.
        assert!((corona / disc - 1.0).abs() < 0.05, "{corona}, {disc}");
    }
    // The same number for all large x, but for corrections of the same order and the noise of resonances.
    assert!((small.2 / large.2 - 1.0).abs() < 0.05, "{small:?} {large:?}");
}

#[test]
fn extrema_are_found_between_the_angles() {
    let degrees: Vec<f64> = [0.0, 0.9, 2.1, 3.0, 4.2, 5.0].into();
    let values: Vec<f64> = degrees.iter().map(|x| (-(x - 2.6_f64).powi(2)).exp()).collect();
    // The logarithm is the parabola itself.
    assert!((highest(&degrees, &values, (0.0, 5.0)).expect("there") - 2.6).abs() < 1e-12);
    assert_eq!(highest(&degrees, &values, (4.0, 5.0)), None);
    let hollow: Vec<f64> = values.iter().map(|v| 1.0 / v).collect();
    assert!((deepest(&degrees, &hollow, (0.0, 5.0)).expect("there") - 2.6).abs() < 1e-12);
}
