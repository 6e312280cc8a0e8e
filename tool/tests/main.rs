//! The command-line tool, end to end, with the files that it reads and the documentation that tells how to run it.

mod accuracy_tool;
mod after_tool;
mod areas;
mod bench;
mod body_tool;
mod branch_tool;

#[cfg(unix)]
mod commands;
mod contact_tool;
mod fraction_tool;
mod free_tool;
mod hardness_tool;
mod hints;
mod hostile;
mod interface_tool;
#[cfg(unix)]
mod interruption;
mod laws_tool;
mod leak_tool;
#[cfg(target_os = "linux")]
mod memory;
mod mirror_tool;
mod pair_tool;
mod pictures;
mod places;
mod prepare;
mod promised;
mod pull_off_tool;
mod scene_tool;
mod selftest;
mod study;
mod surface_tool;
mod sweep_tool;
mod tool;
mod units_tool;
mod warnings;
