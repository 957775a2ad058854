//! The command `airlight`.

use std::process::ExitCode;

fn main() -> ExitCode {
    renderer::cli::main()
}
