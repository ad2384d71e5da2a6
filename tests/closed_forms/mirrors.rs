//! Facts that are written in both Rust and WGSL, compared with the linked modules.

use std::collections::BTreeSet;

use sabi_export::Channel;
use sabi_nodes::link::{LinkedModule, Mirror, ModuleSpec, Reflection};
use sabi_tidy::{assert_none, files_below, text_of};

/// Crates that share data with shaders.
const SHARING: [&str; 5] = ["sabi_engine", "sabi_gpu", "sabi_plan", "sabi_surface", "sabi_view"];

fn mirrors() -> Vec<Mirror> {
    [sabi_gpu::mirrors(), sabi_view::mirrors()].concat()
}

/// Returns all modules of Sabi, with the declarations that the shader compiler finds in them.
fn modules() -> Vec<(LinkedModule, Reflection)> {
    let specs = [sabi_gpu::fixed_modules(), sabi_view::view_modules()].concat();
    assert!(specs.len() > 20);
    let linked = specs.iter().map(|spec| {
        let module = spec.link().unwrap_or_else(|fault| panic!("{}: {fault}", spec.label));
        let reflection = module
            .reflect()
            .unwrap_or_else(|fault| panic!("{}: {fault}", spec.label));
        (module, reflection)
    });
    linked.collect()
}

#[test]
fn values_repeated_in_rust_are_those_of_the_shaders() {
    let modules = modules();
    let mut faults = BTreeSet::new();
    for mirror in mirrors() {
        let with_file = modules
            .iter()
            .filter(|(module, _)| module.shared_files().any(|file| file == mirror.file));
        let mut is_found = false;
        for (_, reflection) in with_file {
            is_found = true;
            faults.extend(mirror.differences(reflection));
        }
        if !is_found {
            faults.insert(format!(
                "{}: no module is linked from {}.wgsl.",
                mirror.rust, mirror.file
            ));
        }
    }
    assert_none(faults.into_iter().collect());
}

#[test]
fn every_struct_that_is_uploaded_mirrors_one_of_a_shader() {
    let registered: BTreeSet<String> = mirrors().into_iter().map(|mirror| mirror.rust).collect();
    let mut faults = Vec::new();
    for folder in SHARING {
        let files = files_below(&format!("crates/{folder}/src"));
        for path in files.into_iter().filter(|path| path.ends_with(".rs")) {
            let text = text_of(&path);
            if text.contains("repr(C)") {
                faults.push(format!(
                    "{path}: a struct is `repr(C)`: declare it with `wgsl_struct!`."
                ));
            }
            for declared in text.split("wgsl_struct! {").skip(1) {
                let name = declared.split_once(" struct ").map_or("", |(_, rest)| rest);
                let name = name.split_whitespace().next().unwrap_or_default();
                if !registered.contains(name) {
                    faults.push(format!(
                        "{path}: `{name}` is not among the `mirrors()` of its crate: add it."
                    ));
                }
            }
        }
    }
    assert_none(faults);
}

#[test]
fn every_shader_file_is_part_of_a_module() {
    let modules = modules();
    let linked: BTreeSet<String> = modules
        .iter()
        .flat_map(|(module, _)| module.shared_files().map(str::to_owned))
        .collect();
    let mut faults = Vec::new();
    for folder in ["surface", "view"] {
        for path in files_below(&format!("shaders/{folder}")) {
            let name = path.trim_start_matches("shaders/").trim_end_matches(".wgsl");
            // Kernels that shoot rays, or read means over them, are made of nodes.
            let is_of_nodes = ["surface/denoise", "surface/shoot"].contains(&name);
            if !linked.contains(name) && !is_of_nodes {
                faults.push(format!("{path} is part of no module: link it or remove it."));
            }
        }
    }
    assert_none(faults);
}

#[test]
fn channels_that_nothing_sets_are_exported_as_those_of_the_plain_material() {
    let spec = ModuleSpec {
        label: "core",
        files: vec!["core"],
        given: Vec::new(),
    };
    let reflection = spec.link().and_then(|module| module.reflect()).unwrap();
    let exported = [
        Channel::BaseColor,
        Channel::Opacity,
        Channel::Roughness,
        Channel::Metallic,
        Channel::Occlusion,
        Channel::Height,
    ];
    let neutral = |channels: &[Channel]| -> Vec<f64> {
        let values = channels.iter().flat_map(Channel::neutral);
        values.map(|value| f64::from(*value)).collect()
    };
    let coats = neutral(&[Channel::Emission, Channel::Coat, Channel::CoatRoughness]);
    let rest = neutral(&[
        Channel::Sheen,
        Channel::SheenRoughness,
        Channel::Subsurface,
        Channel::Transmission,
    ]);
    // The slope is a normal on the maps, and scratches a direction in the tangent frame with a strength.
    let none = vec![0.0; 3];
    assert_eq!(
        reflection.constants["PLAIN_MATERIAL"],
        [neutral(&exported), none.clone(), coats, none, rest].concat()
    );
    assert_eq!(Channel::Anisotropy.neutral()[2], 0.0);
    assert_eq!(Channel::Normal.neutral(), [0.0, 0.0, 1.0]);
}
