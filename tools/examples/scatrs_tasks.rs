//! The crate `scatrs` on the tasks by which Mie solvers are compared (`airlight-tools mie --task a|b`), for
//! `tools/benches/mie_peers.py`: `scatrs_tasks a|b IN OUT REPEAT` prints the seconds of the fastest repeat.

use num_complex::Complex64;
use scatrs::mie::{AmplitudeBuffers, AngularTable, Mie, MieOptions, default_n_max};
use std::error::Error;
use std::f64::consts::PI;
use std::fmt::Write;
use std::time::Instant;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [task, input, output, repeat] = arguments.as_slice() else { return Err("a|b IN OUT REPEAT".into()) };
    let text = std::fs::read_to_string(input)?;
    let (mut fastest, mut result) = (f64::INFINITY, String::new());
    for _ in 0..repeat.parse::<u32>()? {
        let (time, csv) = if task == "a" { efficiencies(&text)? } else { distributions(&text)? };
        (fastest, result) = (fastest.min(time), csv);
    }
    std::fs::write(output, result)?;
    std::io::Write::write_all(&mut std::io::stdout(), format!("{{\"seconds_min\": {fastest:e}}}\n").as_bytes())?;
    Ok(())
}

fn efficiencies(text: &str) -> Result<(f64, String), Box<dyn Error>> {
    let mut spheres: Vec<(f64, Complex64)> = Vec::new();
    for row in csv::Reader::from_reader(text.as_bytes()).deserialize() {
        let (x, n, minus_k): (f64, f64, f64) = row?;
        spheres.push((x, Complex64::new(n, -minus_k)));
    }
    let mut mie = Mie::<f64>::new();
    let start = Instant::now();
    let mut found = Vec::with_capacity(spheres.len());
    for &(x, m) in &spheres {
        found.push(mie.compute(x, m, &MieOptions::new())?.efficiencies());
    }
    let time = start.elapsed().as_secs_f64();
    let mut csv = String::from("Qext,Qsca,g\n");
    for q in found {
        writeln!(csv, "{:e},{:e},{:e}", q.q_ext, q.q_sca, q.g)?;
    }
    Ok((time, csv))
}

fn distributions(text: &str) -> Result<(f64, String), Box<dyn Error>> {
    let input: serde_json::Value = serde_json::from_str(text)?;
    let list = |value: &serde_json::Value| -> Vec<f64> {
        value.as_array().into_iter().flatten().filter_map(serde_json::Value::as_f64).collect()
    };
    let mu: Vec<f64> = list(&input["angles_deg"]).iter().map(|a| a.to_radians().cos()).collect();
    let mut mie = Mie::<f64>::new();
    let (mut csv, mut time) = (String::from("mode,iw,Cext,Csca,g"), 0.0);
    for j in 0..mu.len() {
        write!(csv, ",P{j}")?;
    }
    csv.push('\n');
    for (name, mode) in input.as_object().into_iter().flatten().filter(|(name, _)| *name != "angles_deg") {
        let (r, w) = (list(&mode["r"]), list(&mode["w"]));
        let number = |key: &str| mode[key].as_f64().ok_or("a number");
        let m = Complex64::new(number("m_re")?, -number("m_im")?);
        let wavelengths = list(&mode["wavelengths"]);
        let start = Instant::now();
        let largest = r.iter().fold(0.0, |a: f64, b| a.max(*b)) / wavelengths.iter().fold(f64::MAX, |a, b| a.min(*b));
        let table = AngularTable::new(&mu, default_n_max(2.0 * PI * largest))?;
        let (mut s1, mut s2) = (vec![Complex64::ZERO; mu.len()], vec![Complex64::ZERO; mu.len()]);
        let mut rows = Vec::new();
        for wavelength in &wavelengths {
            let (mut sums, mut phase) = ([0.0; 3], vec![0.0; mu.len()]);
            for (r, w) in r.iter().zip(&w) {
                let sphere = mie.compute(2.0 * PI * r / wavelength, m, &MieOptions::new())?;
                let q = sphere.efficiencies();
                let area = w * PI * r * r;
                for (sum, value) in sums.iter_mut().zip([q.q_ext, q.q_sca, q.q_sca * q.g]) {
                    *sum += area * value;
                }
                sphere.amplitudes_from_table(&table, AmplitudeBuffers { s1: &mut s1, s2: &mut s2 })?;
                for (sum, (a, b)) in phase.iter_mut().zip(s1.iter().zip(&s2)) {
                    *sum += 0.5 * w * (a.norm_sqr() + b.norm_sqr());
                }
            }
            rows.push((sums, phase));
        }
        time += start.elapsed().as_secs_f64();
        for (i, (sums, phase)) in rows.iter().enumerate() {
            write!(csv, "{name},{i},{:e},{:e},{:e}", sums[0], sums[1], sums[2] / sums[1])?;
            for p in phase {
                write!(csv, ",{p:e}")?;
            }
            csv.push('\n');
        }
    }
    Ok((time, csv))
}
