//! Files from elsewhere, which are no part of the project. `CONTRIBUTING.md` says how to run these tests.

use std::path::{Path, PathBuf};

use sabi_surface::load::{LoadOptions, load, load_bytes};

use crate::promises;

/// Folder of these files.
pub(crate) fn data() -> PathBuf {
    let folder = std::env::var_os("SABI_TEST_DATA");
    PathBuf::from(folder.expect("SABI_TEST_DATA names the folder of the files"))
}

/// All files of a folder and those below it, in order.
pub(crate) fn files_under(folder: &Path, files: &mut Vec<PathBuf>) {
    let mut entries: Vec<PathBuf> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    entries.sort();
    for entry in entries {
        if entry.is_dir() {
            files_under(&entry, files);
        } else {
            files.push(entry);
        }
    }
}

#[test]
#[ignore = "reads files that SABI_TEST_DATA names"]
fn every_file_gives_a_whole_model_or_a_sentence() {
    let data = data();
    let mut files = Vec::new();
    files_under(&data.join("meshes"), &mut files);
    files_under(&data.join("hostile/gltf-validator"), &mut files);
    let is_model = |file: &PathBuf| {
        file.extension()
            .is_some_and(|ending| ["gltf", "glb", "obj"].iter().any(|known| ending == *known))
    };
    files.retain(is_model);
    // Every file in these folders is loaded as a model, whatever its extension.
    for folder in ["assimp-invalid", "tinygltf-models", "tinygltf-tests"] {
        files_under(&data.join("hostile").join(folder), &mut files);
    }
    for file in files {
        let name = file.strip_prefix(&data).unwrap().display().to_string();
        match load(&file, &LoadOptions::default()) {
            Ok(model) => {
                promises::check(&model);
                println!("{name}: {} triangles, {:?}", model.mesh.triangles.len(), model.warnings);
            }
            Err(error) => {
                assert!(error.fault.to_string().len() > 15, "{name}: {error}");
                println!("{name}: refused, {}", error.fault);
            }
        }
    }
}

#[test]
#[ignore = "reads files that SABI_TEST_DATA names"]
fn known_models_have_all_their_triangles() {
    let data = data();
    // Counted over instances where a mesh is placed more than once.
    for (file, triangles) in [
        ("bevy-FlightHelmet/FlightHelmet.gltf", 94_722),
        (
            "khr-AnimatedMorphCube-Quantized/glTF-Quantized/AnimatedMorphCube.gltf",
            12,
        ),
        ("khr-Box-Draco/glTF-Draco/Box.gltf", 12),
        ("khr-MorphPrimitivesTest-Draco/glTF-Draco/MorphPrimitivesTest.gltf", 32),
        ("gltf-transform-tests/extensions/test/in/BoxMeshopt.gltf", 12),
        ("gltf-transform-tests/extensions/test/in/DracoSparseMesh.gltf", 102),
        ("khr-Box_With_Spaces/glTF/Box With Spaces.gltf", 12),
        ("khr-BoxInterleaved/glTF/BoxInterleaved.gltf", 12),
        ("khr-Fox/glTF/Fox.gltf", 576),
        ("khr-MeshPrimitiveModes/glTF/MeshPrimitiveModes.gltf", 16),
        (
            "khr-MetalRoughSpheresNoTextures/glTF/MetalRoughSpheresNoTextures.gltf",
            1_040_409,
        ),
        ("khr-NormalTangentTest/glTF/NormalTangentTest.gltf", 7_774),
        ("khr-SheenChair/glTF/SheenChair.gltf", 39_936),
        ("khr-SimpleSparseAccessor/glTF/SimpleSparseAccessor.gltf", 12),
        ("khr-TriangleWithoutIndices/glTF/TriangleWithoutIndices.gltf", 1),
        ("khr-WaterBottle/glTF/WaterBottle.gltf", 4_510),
        ("materialmaker-meshes/pillow.obj", 1_156),
        ("materialx-geometry/plane.obj", 1_800),
        ("ode-koala/koala.obj", 99_994),
        ("ode-spot/spot_control_mesh.obj", 372),
        ("bench-suzanne30k/mesh30k.glb", 29_999),
    ] {
        let model = load(&data.join("meshes").join(file), &LoadOptions::default()).unwrap();
        assert_eq!(model.mesh.triangles.len(), triangles, "{file}");
    }
}

#[test]
#[ignore = "reads files that SABI_TEST_DATA names"]
fn made_tangents_agree_with_those_that_other_programs_stored() {
    let data = data();
    let folder = data.join("meshes/bevy-FlightHelmet");
    let text = std::fs::read_to_string(folder.join("FlightHelmet.gltf")).unwrap();
    let mut beside = |uri: &str| std::fs::read(folder.join(uri)).map_err(|error| error.to_string());
    let mut read = |text: &str| load_bytes("a.gltf", text.as_bytes(), &mut beside, &LoadOptions::default()).unwrap();
    let stored = read(&text).mesh;
    let made = read(&text.replace("\"TANGENT\"", "\"_TANGENT\"")).mesh;
    let corners = stored
        .triangles
        .as_flattened()
        .iter()
        .zip(made.triangles.as_flattened());
    let agree = corners.filter(|(stored_at, made_at)| {
        let (a, b) = (stored.tangents[**stored_at as usize], made.tangents[**made_at as usize]);
        a[3] == b[3] && a[0] * b[0] + a[1] * b[1] + a[2] * b[2] > 0.99
    });
    let share = agree.count() as f32 / (stored.triangles.len() * 3) as f32;
    assert!(share > 0.98, "{share}");
}
