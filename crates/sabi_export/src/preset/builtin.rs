//! Presets that come with Sabi: the files of `assets/presets`.

use super::Preset;

/// Names of the presets that come with Sabi, the default first.
pub const BUILTIN_NAMES: [&str; 8] = ["raw", "gltf", "unreal", "unity", "godot", "blender", "materialx", "usd"];

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
        _ => return None,
    })
}

/// A preset that comes with Sabi; `None` for any other name.
pub fn builtin(name: &str) -> Option<Preset> {
    let text = builtin_text(name)?;
    // A test reads all of them.
    Preset::parse(name, text).ok()
}

/// The default preset: one file for each channel, nothing packed.
pub fn raw() -> Preset {
    // A test reads it.
    builtin("raw").unwrap_or_else(|| Preset {
        name: "raw".to_owned(),
        about: String::new(),
        normal_y: super::NormalY::Up,
        names: String::new(),
        maps: Vec::new(),
    })
}
