//! What stands below the flags in the help: examples, and what the program ends with.

/// Of the program itself.
pub(super) const PROGRAM: &str = "\
Exit codes:
  0    done
  1    an error: a file that cannot be read or written, tables that --check finds changed;
       of lint: findings
  2    words that make no sense; of lint: a file that cannot be judged

Results go to files and to standard output; what was done, and errors, one sentence each, to
standard error. With the variable NO_COLOR set the help has no colours, and nothing else has any.
The flags of a command: airlight-tools COMMAND --help";

pub(super) const BUILD: &str = "\
Examples:
  airlight-tools build                                         raw-data/ -> data/, replacing the tables there
  airlight-tools build --check                                 is data/ what raw-data/ makes?
  airlight-tools build --only ozone --data /tmp/tables";

pub(super) const IMPORT: &str = "\
Examples:
  airlight-tools import albedo grass.csv --name grass -o grass.table
  airlight-tools import atmosphere sonde.csv -o sonde.table
  airlight-tools import aerosol --modes modes.csv --index index.csv --scale-height 2 --top 12 -o haze.table
then airlight render --table haze.table";

pub(super) const INSPECT: &str = "\
Examples:
  airlight-tools inspect data/rayleigh.table
  airlight-tools inspect data/*.table --json";

pub(super) const COEFFICIENTS: &str = "\
Examples:
  airlight-tools coefficients --altitude 0:80:1 --wavelength 450,550,650 -o air.csv
  airlight-tools coefficients --biome urban --quantity optical-depth --wavelength 300:1000:10";

pub(super) const EXPORT: &str = "\
Examples:
  airlight-tools export data/rayleigh.table
  airlight-tools export data/sun.table --field irradiance -o sun.json
  airlight-tools export --for mitsuba --biome rural --wavelength 450,550,650 -o air";

pub(super) const SOURCES: &str = "\
Examples:
  airlight-tools sources
  airlight-tools sources --format csv --raw-data raw-data";

pub(super) const MIE: &str = "\
Example:
  airlight-tools mie --cases spheres.csv --out efficiencies.csv";

pub(super) const BIOMES: &str = "\
Examples:
  airlight-tools biomes
  airlight-tools biomes --json";

pub(super) const LINT: &str = "\
Examples:
  airlight-tools lint data
  airlight-tools lint sonde.csv --json
  airlight-tools lint desert-dust --source opac";

#[cfg(feature = "plot")]
pub(super) const PLOT: &str = "\
Examples:
  airlight-tools plot                                          all figures, replacing those in plots/
  airlight-tools plot optical-depth --biome urban --out /tmp/plots";

#[cfg(feature = "plot")]
pub(super) const CHART: &str = "\
Example:
  airlight study ladder --quick -o ladder.csv && airlight-tools chart ladder.csv      ladder.svg and ladder.png";

#[cfg(feature = "study")]
pub(super) const STUDY: &str = "\
Examples:
  airlight-tools study rayleigh
  airlight-tools study thesis --out /tmp/studies";

pub(super) const REPORT: &str = "\
Example:
  airlight-tools report -o report.html";
