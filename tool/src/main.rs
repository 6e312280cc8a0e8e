//! The program `asperity`.

use std::env;
use std::process::ExitCode;

fn main() -> ExitCode {
    let program = env::current_exe().ok().map(Into::into).or_else(|| env::args_os().next());
    ExitCode::from(asperity_tool::run(program.as_slice(), env::args_os()))
}
