//! Any bytes are a whole model or a fault. What follows a line of five dashes is the file beside it: the buffer of a
//! `.gltf`, the material library of an `.obj`, a picture of others.

use sabi_surface::load::{LoadOptions, load_bytes};

use crate::parts::files;
use crate::promises;

#[allow(dead_code, reason = "each target calls one of them")]
pub fn survives_as_gltf(bytes: &[u8]) {
    if bytes.starts_with(b"glTF") {
        survives("model.glb", bytes, &[]);
    } else {
        with_the_file_beside("model.gltf", bytes);
    }
}

#[allow(dead_code, reason = "each target calls one of them")]
pub fn survives_as_obj(bytes: &[u8]) {
    with_the_file_beside("model.obj", bytes);
}

#[allow(dead_code, reason = "each target calls one of them")]
pub fn survives_as_fbx(bytes: &[u8]) {
    survives("model.fbx", bytes, &[]);
}

#[allow(dead_code, reason = "each target calls one of them")]
pub fn survives_as_dae(bytes: &[u8]) {
    survives("model.dae", bytes, &[]);
}

#[allow(dead_code, reason = "each target calls one of them")]
pub fn survives_as_ply(bytes: &[u8]) {
    with_the_file_beside("model.ply", bytes);
}

#[allow(dead_code, reason = "each target calls one of them")]
pub fn survives_as_stl(bytes: &[u8]) {
    survives("model.stl", bytes, &[]);
}

fn with_the_file_beside(name: &str, bytes: &[u8]) {
    match files(bytes, 2)[..] {
        [file, beside] => survives(name, file, beside),
        _ => survives(name, bytes, &[]),
    }
}

fn survives(name: &str, file: &[u8], beside: &[u8]) {
    let mut resolve = |_: &str| Ok(beside.to_vec());
    let options = LoadOptions {
        memory_bytes: 256 << 20,
        ..LoadOptions::default()
    };
    if let Ok(model) = load_bytes(name, file, &mut resolve, &options) {
        promises::check(&model);
    }
}
