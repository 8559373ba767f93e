//! The program with models of one's own: what is registered before it reads its command line, studies can name, and every command knows.
//!
//! `cargo run --release --example own_models -- simulate --model belt --start x=2`

use std::process::ExitCode;

use capsulemap::of::register;
use capsulemap_oscillators::{BELT, IMPACT};

fn main() -> ExitCode {
    for model in [IMPACT, BELT] {
        register(model).expect("the names of the models are free");
    }
    capsulemap::cli::main("unknown")
}
