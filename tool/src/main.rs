//! The program `asperity`.

use std::env;
use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(asperity_tool::run(env::args_os()))
}
