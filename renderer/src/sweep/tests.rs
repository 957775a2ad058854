use super::*;

#[test]
fn sweep() {
    let plan = Plan { seed: 1, paths: 1_000_000, method: Estimator::Paths };
    let report = plan.run(&|_| ());
    assert_eq!((report.scenes, report.paths), (977, 1_000_000));
    assert_eq!((report.bad, &report.examples), (0, &vec![]));
}

#[test]
fn sweep_of_the_judge() {
    let plan = Plan { seed: 2, paths: 20_000, method: Estimator::Judge };
    let report = plan.run(&|_| ());
    assert_eq!((report.bad, &report.examples), (0, &vec![]));
}

#[test]
fn sweep_is_the_same_on_one_thread_and_three() {
    let plan = Plan { seed: 3, paths: 40_000, method: Estimator::Paths };
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| plan.run(&|_| ()))
    };
    assert_eq!(on(1), on(3));
}

#[test]
fn sweep_notices_what_is_wrong() {
    assert_eq!(fault(&[0.0, 1.0], 3), None);
    assert_eq!(fault(&[0.0, f64::NAN], 3), Some(Fault::NotFinite));
    assert_eq!(fault(&[f64::INFINITY], 3), Some(Fault::NotFinite));
    assert_eq!(fault(&[1.0, -1e-300], 3), Some(Fault::Negative));
    assert_eq!(fault(&[1.0], ENDLESS), Some(Fault::Endless));
}

#[test]
fn sweep_keeps_the_laws() {
    let laws = laws(0, 8);
    assert!(laws.kept(), "{laws:?}");
}
