#!/usr/bin/env python3
"""Times Airlight's Mie solver beside others in one run, on one core, and writes a row for each as CSV.

    cargo build --release -p tools --example scatrs_tasks --bin airlight-tools
    python3 tools/benches/mie_peers.py --bin target/release --reference REFERENCE.npz --out raw-data/mie-peers/speed.csv

Needs numpy; solvers that are not installed (pip install miepython numba sasktran2 PyMieScatt) are left out and named.
PyMieScatt wants an older Python stack: --old PYTHON names an interpreter that has it.

Tasks. a: extinction, scattering and g of 1000 spheres, x from 0.01 to 1000 in equal factors, m = 1.5 - 0.01i. b: two
log-normals (median radii 0.0118 and 0.39 um, sigma_g 2, m = 1.75 - 0.44i and 1.53 - 0.0055i) at 61 wavelengths from 0.3
to 4 um with 1000 radii each: cross-sections, g and a phase function at 181 angles. A solver that is too slow for all of b
does some wavelengths of it; spheres per second count those done. Errors are the largest relative ones against
arbitrary-precision values (--reference, an .npz with xa, Qa, tot_soot, tot_mineral, P_soot, P_mineral), if given."""
import argparse, csv, json, math, os, platform, subprocess, sys, tempfile, time

import numpy as np

WAVELENGTHS = np.geomspace(0.3, 4.0, 61)
MODES = {  # median radius, smallest, largest (um), n, k
    "soot": (0.0118, 1e-3, 5.0, 1.75, 0.44),
    "mineral": (0.39, 1e-2, 50.0, 1.53, 0.0055),
}
ANGLES = np.arange(181.0)
MU = np.cos(np.radians(ANGLES))
MU[90] = 0.0


def distribution(mode):
    median, smallest, largest, _, _ = MODES[mode]
    t = np.linspace(math.log(smallest), math.log(largest), 1000)
    s = math.log(2.0)
    w = (t[1] - t[0]) * np.exp(-0.5 * ((t - math.log(median)) / s) ** 2) / (math.sqrt(2 * math.pi) * s)
    w[0] /= 2
    w[-1] /= 2
    return np.exp(t), w


def adapter(name):
    """(efficiencies(x, n, k) -> Qext, Qsca, g; amplitudes(x, n, k) -> those and |S1|^2 + |S2|^2 at MU)."""
    if name == "miepython":
        os.environ["MIEPYTHON_USE_JIT"] = "1"
        import miepython

        def efficiencies(x, n, k):
            ext, sca, _, g = miepython.efficiencies_mx(complex(n, -k), x)
            return ext, sca, g

        def amplitudes(x, n, k):
            intensity = np.empty((len(x), len(MU)))
            for i, one in enumerate(x):
                s1, s2 = miepython.S1_S2(complex(n, -k), float(one), MU, norm="wiscombe")
                intensity[i] = np.abs(s1) ** 2 + np.abs(s2) ** 2
            return efficiencies(x, n, k), intensity

        return efficiencies, amplitudes
    if name == "sasktran2":
        import sasktran2

        solver = sasktran2.mie.LinearizedMie()

        def both(x, n, k, mu):
            r = solver.calculate(x, complex(n, -k), mu)
            return (np.array(r.Qext), np.array(r.Qsca), None), np.abs(r.S1) ** 2 + np.abs(r.S2) ** 2

        return (lambda x, n, k: both(x, n, k, np.array([1.0]))[0]), (lambda x, n, k: both(x, n, k, MU))
    if name == "PyMieScatt":
        import PyMieScatt

        def efficiencies(x, n, k):
            q = np.array([PyMieScatt.MieQ(complex(n, k), math.pi, float(one)) for one in x])
            return q[:, 0], q[:, 1], q[:, 3]

        return efficiencies, None
    raise KeyError(name)


def worker(name, budget):
    efficiencies, amplitudes = adapter(name)
    rows = {}
    x = np.geomspace(0.01, 1000.0, 1000)
    x = REFERENCE["xa"] if REFERENCE else x
    efficiencies(x[:50], 1.5, 0.01)
    fastest, begun = math.inf, time.time()
    while fastest == math.inf or time.time() - begun < budget:
        start = time.process_time()
        found = efficiencies(x.copy(), 1.5, 0.01)
        fastest = min(fastest, time.process_time() - start)
    rows["a"] = dict(spheres=len(x), seconds=fastest, error=error_a(found))
    if amplitudes:
        chosen, fastest = None, math.inf
        for chosen in (range(61), range(0, 61, 10), (0, 30, 60), (60,)):
            start = time.process_time()
            run_b(amplitudes, [60] if len(chosen) > 1 else chosen)
            if (time.process_time() - start) * len(chosen) < 5 * budget:
                break
        begun = time.time()
        while fastest == math.inf or time.time() - begun < budget:
            start = time.process_time()
            found = run_b(amplitudes, chosen)
            fastest = min(fastest, time.process_time() - start)
        rows["b"] = dict(spheres=2000 * len(chosen), seconds=fastest, error=error_b(found))
    print(json.dumps(rows))


def run_b(amplitudes, chosen):
    found = {}
    for mode in MODES:
        r, w = distribution(mode)
        for i in chosen:
            (ext, sca, _), intensity = amplitudes(2 * math.pi * r / WAVELENGTHS[i], *MODES[mode][3:])
            area = w * math.pi * r * r
            found[mode, i] = (area @ ext, area @ sca, 0.5 * (w @ intensity))
    return found


def relative(found, exact):
    return float(np.max(np.abs(np.asarray(found) / exact - 1)))


def error_a(found):
    if not REFERENCE:
        return None
    exact = REFERENCE["Qa"]
    return max(relative(f, exact[:, j]) for f, j in zip(found, (0, 1, 3)) if f is not None)


def error_b(found):
    if not REFERENCE:
        return None
    worst = 0.0
    for (mode, i), (ext, sca, phase) in found.items():
        total = REFERENCE["tot_" + mode][i]
        worst = max(worst, relative([ext, sca], total[:2]), relative(phase, REFERENCE["P_" + mode][i]))
    return worst


def protocol(command, folder, repeat):
    """A program that takes the tasks as files and prints the seconds of its fastest repeat."""
    x = REFERENCE["xa"] if REFERENCE else np.geomspace(0.01, 1000.0, 1000)
    rows = {}
    for task in ("a", "b"):
        source, target = os.path.join(folder, task + ".in"), os.path.join(folder, task + ".out")
        with open(source, "w") as file:
            if task == "a":
                file.write("x,m_re,m_im\n" + "".join(f"{float(v)!r},1.5,-0.01\n" for v in x))
            else:
                json.dump({"angles_deg": ANGLES.tolist()} | {
                    mode: dict(wavelengths=WAVELENGTHS.tolist(), r=distribution(mode)[0].tolist(),
                               w=distribution(mode)[1].tolist(), m_re=MODES[mode][3], m_im=-MODES[mode][4])
                    for mode in MODES}, file)
        count = repeat if task == "a" else max(1, repeat // 10)
        done = subprocess.run(command(task, source, target, count), capture_output=True, text=True, check=True)
        seconds = json.loads(done.stdout.strip().splitlines()[-1])["seconds_min"]
        table = list(csv.DictReader(open(target)))
        if task == "a":
            error = error_a([np.array([float(row[q]) for row in table]) for q in ("Qext", "Qsca", "g")])
        else:
            error = error_b({(row["mode"], int(row["iw"])): (
                float(row["Cext"]), float(row["Csca"]), np.array([float(row[f"P{j}"]) for j in range(181)]))
                for row in table})
        rows[task] = dict(spheres=1000 if task == "a" else 122000, seconds=seconds, error=error)
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bin", default="target/release", help="folder of airlight-tools and examples/scatrs_tasks")
    parser.add_argument("--out", help="CSV to write; printed as well")
    parser.add_argument("--reference", help="arbitrary-precision values")
    parser.add_argument("--old", default=sys.executable, help="Python that has PyMieScatt")
    parser.add_argument("--budget", type=float, default=3.0, help="seconds for each measurement")
    parser.add_argument("--repeat", type=int, default=50, help="repeats of task a of compiled programs; a tenth of b")
    parser.add_argument("--worker", help=argparse.SUPPRESS)
    options = parser.parse_args()
    global REFERENCE
    REFERENCE = np.load(options.reference) if options.reference else None
    if options.worker:
        return worker(options.worker, options.budget)
    found = {}
    airlight = os.path.join(options.bin, "airlight-tools")
    with tempfile.TemporaryDirectory() as folder:
        for name in ("plain", "avx2", "avx512"):
            def command(task, source, target, count, name=name):
                return [airlight, "mie", "--task", task, "--in", source, "--out", target, "--repeat", str(count),
                        "--instructions", name]
            try:
                found["Airlight, " + name] = protocol(command, folder, options.repeat)
            except subprocess.CalledProcessError as error:
                print("left out:", name, error.stderr.strip().splitlines()[-1:], file=sys.stderr)
        scatrs = os.path.join(options.bin, "examples", "scatrs_tasks")
        found["scatrs"] = protocol(lambda *a: [scatrs, *map(str, a)], folder, max(10, options.repeat // 5))
    environment = os.environ | {v: "1" for v in ("OMP_NUM_THREADS", "NUMBA_NUM_THREADS", "OPENBLAS_NUM_THREADS",
                                                 "RAYON_NUM_THREADS")}
    for name, python in (("miepython", sys.executable), ("sasktran2", sys.executable), ("PyMieScatt", options.old)):
        command = [python, __file__, "--worker", name, "--budget", str(options.budget)]
        command += ["--reference", options.reference] if options.reference else []
        done = subprocess.run(command, capture_output=True, text=True, env=environment)
        if done.returncode:
            print("left out:", name, done.stderr.strip().splitlines()[-1:], file=sys.stderr)
            continue
        found[name] = json.loads(done.stdout.strip().splitlines()[-1])
    cpu = next((line.split(":")[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")), "")
    flags = next((line for line in open("/proc/cpuinfo") if line.startswith("flags")), "")
    widest = "AVX-512" if "avx512f" in flags else "AVX2" if "avx2" in flags else "SSE2"
    lines = [
        "# title: Speed and error of Mie solvers",
        "# citation: measured by tools/benches/mie_peers.py, which says what the tasks are",
        f"# source: one run, one core of {cpu} ({widest}), {platform.system()}",
        f"# retrieved: {time.strftime('%Y-%m-%d')}",
        "# licence: same as Airlight",
        "# changes: none",
        "# unit solver: text",
        "# unit task: text",
        "# unit spheres_per_second: s^-1",
        "# unit largest_relative_error: 1",
        "solver,task,spheres_per_second,largest_relative_error",
    ]
    for name, tasks in found.items():
        for task, row in tasks.items():
            error = "" if row["error"] is None else f"{row['error']:.2g}"
            lines.append(f"\"{name}\",{task},{row['spheres'] / row['seconds']:.4g},{error}")
    text = "\n".join(lines) + "\n"
    print(text, end="")
    if options.out:
        with open(options.out + ".tmp", "w") as file:
            file.write(text)
        os.replace(options.out + ".tmp", options.out)


if __name__ == "__main__":
    main()
