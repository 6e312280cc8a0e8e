//! Writes the JavaScript module next to a WebAssembly one: `asperity-web-bindings IN.wasm DIR`.

use std::env;
use std::error::Error;

use wasm_bindgen_cli_support::Bindgen;

fn main() -> Result<(), Box<dyn Error>> {
    let [input, folder] = &env::args().skip(1).collect::<Vec<_>>()[..] else {
        return Err("give the .wasm and a folder".into());
    };
    let mut bindgen = Bindgen::new();
    // names of functions are a tenth of the size
    bindgen.input_path(input).typescript(false).remove_name_section(true).remove_producers_section(true);
    Ok(bindgen.web(true)?.generate(folder)?)
}
