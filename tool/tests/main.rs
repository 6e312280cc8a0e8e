//! The command-line tool, end to end, with the files that it reads and the documentation that tells how to run it.

mod accuracy;
mod after;
mod areas;
mod bench;
mod body;
mod branch;

#[cfg(unix)]
mod commands;
mod contact;
mod fraction;
mod free;
mod givens;
mod hardness;
mod hints;
mod hostile;
mod interface;
#[cfg(unix)]
mod interruption;
mod laws;
mod leak;
#[cfg(target_os = "linux")]
mod memory;
mod mirror;
mod pair;
mod pictures;
mod places;
mod prepare;
mod promised;
mod pull_off;
mod scene;
mod selftest;
mod solve;
mod study;
mod surface;
mod sweep;
mod units;
mod warnings;
