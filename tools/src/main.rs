//! `airlight-tools`: makes and checks the tables of `data/`.

mod cli;

use std::process::ExitCode;

fn main() -> ExitCode {
    cli::run()
}
