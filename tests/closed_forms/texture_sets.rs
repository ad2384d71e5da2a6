//! Every texture is read with its own texture coordinates, whatever layout the maps have.

use sabi_color::srgb8_from_linear;
use sabi_engine::Kinds;
use sabi_engine::opening::linked_model::{ModelOptions, Overlap};
use sabi_image::{PngData, PngOptions, encode_png};
use sabi_tests::{MadeMesh, MeshFile, OnMesh, Quad};

const SIZE: u32 = 64;

const GRAPH: &str = r#"{ "format": "sabi", "version": 1, "nodes": {
    "model": { "kind": "source/model" },
    "out": { "kind": "output/material", "inputs": { "material": "model" } } } }"#;

fn png(pixel: impl Fn(u32, u32) -> [u8; 3]) -> Vec<u8> {
    let codes: Vec<u8> = (0..SIZE * SIZE).flat_map(|at| pixel(at % SIZE, at / SIZE)).collect();
    let options = PngOptions {
        channels: 3,
        bits: 8,
        srgb_chunk: false,
    };
    encode_png(SIZE, SIZE, PngData::U8(&codes), options).expect("a picture")
}

/// Codes of a normal map that leans to the right everywhere.
const LEANING: [u8; 3] = [204, 128, 230];

/// Two upright squares one behind the other, with the same texture coordinates: u goes right, v down. Codes of the picture
/// grow with x and fall with y.
fn stacked() -> MeshFile {
    let square = |z: f32| Quad {
        corners: [[0.0, 0.0, z], [1.0, 0.0, z], [1.0, 1.0, z], [0.0, 1.0, z]],
        uvs: [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]],
    };
    MeshFile {
        quads: vec![square(0.0), square(1.0)],
        base_color: Some(png(|x, y| [(4 * x) as u8, (4 * y) as u8, 77])),
        normal: Some(png(|_, _| LEANING)),
        ..MeshFile::default()
    }
}

fn on(mesh: &MadeMesh, overlap: Overlap) -> OnMesh {
    let options = ModelOptions {
        overlap,
        ..ModelOptions::new(mesh.path(), SIZE)
    };
    OnMesh::on_model(GRAPH, Kinds::builtin(), options, |_| {})
}

/// Compares colors and slopes with those of the picture at the texel's position in space.
fn assert_textured(on_mesh: &mut OnMesh, case: &str) {
    let evaluated = on_mesh.evaluate("out");
    let color = ["base_color.r", "base_color.g", "base_color.b"].map(|name| evaluated.component(name));
    let slope = ["slope.x", "slope.y", "slope.z"].map(|name| evaluated.component(name));
    let mut seen = 0;
    for (index, _) in on_mesh.owned() {
        let Some([x, y, _]) = on_mesh.position(index).map(|place| place.to_array()) else {
            continue;
        };
        let pixel = |along: f64| 4.0 * (along * f64::from(SIZE) - 0.5).clamp(0.0, f64::from(SIZE) - 1.0);
        let wanted = [pixel(x), pixel(1.0 - y), 77.0];
        // Near the border the picture repeats.
        if (0.02..0.98).contains(&x) && (0.02..0.98).contains(&y) {
            for component in 0..3 {
                let is = f64::from(srgb8_from_linear(color[component][index]));
                // One for the interpolation in linear light between two codes, half for rounding, and as codes of
                // neighbors are 4 apart, half for the mean over a texel that covers more than a pixel.
                let off = (is - wanted[component]).abs();
                assert!(
                    off <= 2.0,
                    "{case}: color {component} at ({x}, {y}) is {is}, not {}",
                    wanted[component]
                );
            }
            seen += 1;
        }
        // Tangent +x, bitangent +y, normal +z.
        let [a, b, c] = LEANING.map(|code| 2.0 * f64::from(code) / 255.0 - 1.0);
        let wanted = [-a / c, -b / c, 0.0];
        for axis in 0..3 {
            let off = (f64::from(slope[axis][index]) - wanted[axis]).abs();
            // Slopes are stored as half floats: 11 bits of a number below 1.
            assert!(
                off < 1e-3,
                "{case}: slope {axis} at ({x}, {y}) is {}, not {}",
                slope[axis][index],
                wanted[axis]
            );
        }
    }
    assert!(seen > 800, "{case}: {seen} texels");
}

#[test]
fn textures_and_normal_maps_survive_an_unwrap_of_stacked_charts() {
    let mesh = stacked().write();
    let mut as_it_is = on(&mesh, Overlap::First);
    assert_eq!(as_it_is.atlas().report.stacked_charts, 1);
    assert_textured(&mut as_it_is, "as it is");
    let mut unwrapped = on(&mesh, Overlap::Unwrap);
    assert_eq!(unwrapped.atlas().report.overlap_texels, 0);
    assert_eq!(
        unwrapped
            .evaluator
            .linked()
            .unwrapped
            .as_ref()
            .map(|found| found.uv_set),
        Some(1)
    );
    assert_textured(&mut unwrapped, "unwrapped");
}

#[test]
fn textures_of_a_second_set_come_through_it_in_a_turned_layout() {
    let mut file = stacked();
    file.picture_uvs = Some(file.quads.iter().map(|quad| quad.uvs).collect());
    for quad in &mut file.quads {
        quad.uvs = quad.uvs.map(|[u, v]| [0.1 + 0.8 * v, 0.9 - 0.8 * u]);
    }
    assert_textured(&mut on(&file.write(), Overlap::First), "turned");
}
