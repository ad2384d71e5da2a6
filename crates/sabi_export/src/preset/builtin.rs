//! Presets that come with Sabi: the files of `assets/presets`.

use super::{Preset, PresetError};

/// Names of the presets that come with Sabi, the default first.
pub const BUILTIN_NAMES: [&str; 9] = [
    "raw",
    "gltf",
    "unreal",
    "unity",
    "godot",
    "blender",
    "materialx",
    "usd",
    "mesh",
];

/// The file of a preset that comes with Sabi, as text; `None` for any other name.
pub fn builtin_text(name: &str) -> Option<&'static str> {
    Some(match name {
        "raw" => include_str!("../../../../assets/presets/raw.toml"),
        "gltf" => include_str!("../../../../assets/presets/gltf.toml"),
        "unreal" => include_str!("../../../../assets/presets/unreal.toml"),
        "unity" => include_str!("../../../../assets/presets/unity.toml"),
        "godot" => include_str!("../../../../assets/presets/godot.toml"),
        "blender" => include_str!("../../../../assets/presets/blender.toml"),
        "materialx" => include_str!("../../../../assets/presets/materialx.toml"),
        "usd" => include_str!("../../../../assets/presets/usd.toml"),
        "mesh" => include_str!("../../../../assets/presets/mesh.toml"),
        _ => return None,
    })
}

/// Reads a preset that comes with Sabi; `None` for any other name.
pub fn builtin(name: &str) -> Option<Result<Preset, PresetError>> {
    builtin_text(name).map(|text| Preset::parse(name, text))
}

/// Reads the default preset: one file for each channel, nothing packed.
pub fn raw() -> Result<Preset, PresetError> {
    Preset::parse("raw", include_str!("../../../../assets/presets/raw.toml"))
}
