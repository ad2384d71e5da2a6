//! Embeds the files of `shaders/` in release builds. Debug builds read them at program start, so that a changed shader can
//! be tried without compiling.

use std::path::Path;
use std::{env, fs, io};

#[path = "src/shader_list.rs"]
mod shader_list;

fn main() -> io::Result<()> {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=src/shader_list.rs");
    println!("cargo::rustc-check-cfg=cfg(shaders_included)");
    if variable("PROFILE")? != "release" {
        return Ok(());
    }
    println!("cargo::rustc-cfg=shaders_included");
    let shaders = Path::new(&variable("CARGO_MANIFEST_DIR")?).join("../../shaders");
    println!("cargo::rerun-if-changed={}", shaders.display());
    let mut text =
        String::from("/// Path without ending, and text of each file.\npub(super) const FILES: &[(&str, &str)] = &[\n");
    for (path, file) in shader_list::list(&shaders)? {
        text += &format!("    ({path:?}, include_str!({:?})),\n", file.canonicalize()?);
    }
    text += "];\n";
    fs::write(Path::new(&variable("OUT_DIR")?).join("shaders.rs"), text)
}

fn variable(name: &str) -> io::Result<String> {
    env::var(name).map_err(|error| io::Error::other(format!("cargo sets {name}: {error}")))
}
