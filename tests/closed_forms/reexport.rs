//! `source/model → output/material` gives back the maps that the model came with.

use sabi_image::{PngData, PngOptions, encode_png, srgb8_from_linear};
use sabi_tests::{MadeMesh, MeshFile, OnMesh, Quad};

const SIZE: u32 = 32;

/// 8-bit RGB samples of a picture of `SIZE` by `SIZE`.
type Codes = Vec<u8>;

fn picture(pixel: impl Fn(u32, u32) -> [u8; 3]) -> Codes {
    (0..SIZE * SIZE).flat_map(|at| pixel(at % SIZE, at / SIZE)).collect()
}

fn png(codes: &Codes) -> Vec<u8> {
    let options = PngOptions {
        channels: 3,
        bits: 8,
        srgb_chunk: false,
    };
    encode_png(SIZE, SIZE, PngData::U8(codes), options).expect("a picture")
}

/// Unit normals of many tilts, as a map holds them.
fn normals() -> Codes {
    picture(|x, y| {
        let tilt = |at: u32| f64::from((at * 7) % 23) / 23.0 - 0.5;
        let [a, b] = [tilt(x + 3 * y), tilt(5 * x + y)];
        let length = (1.0 + a * a + b * b).sqrt();
        [a, b, 1.0].map(|part| ((part / length * 0.5 + 0.5) * 255.0).round() as u8)
    })
}

fn colors() -> Codes {
    picture(|x, y| [(8 * x) as u8, (8 * y) as u8, ((x * y) % 256) as u8])
}

/// Two faces at a right angle; the second one's texture coordinates are mirrored. Together they fill the unit square.
fn folded() -> MeshFile {
    let upright = Quad {
        corners: [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.5, 0.0], [0.0, 0.5, 0.0]],
        uvs: [[0.0, 0.5], [1.0, 0.5], [1.0, 0.0], [0.0, 0.0]],
    };
    let mirrored = Quad {
        corners: [[0.0, 0.0, 0.5], [1.0, 0.0, 0.5], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]],
        uvs: [[1.0, 1.0], [0.0, 1.0], [0.0, 0.5], [1.0, 0.5]],
    };
    MeshFile {
        quads: vec![upright, mirrored],
        base_color: Some(png(&colors())),
        normal: Some(png(&normals())),
        picture_uvs: None,
    }
}

const GRAPH: &str = r#"{ "format": "sabi", "version": 1, "nodes": {
    "model": { "kind": "source/model" },
    "out": { "kind": "output/material", "inputs": { "material": "model" } } } }"#;

/// The picture's pixel under each owned texel, with the texel's index.
fn pixels(on_mesh: &OnMesh) -> Vec<(usize, usize)> {
    let pixel = |(index, triangle): (usize, u32)| {
        let atlas = on_mesh.atlas();
        let chart = &atlas.charts[atlas.triangle_chart[triangle as usize] as usize];
        let [_, x, y] = on_mesh.texel(index);
        let [column, row] = [(x, 0), (y, 1)].map(|(at, axis)| at as i32 - chart.texel_from_uv[axis]);
        (index, (row as u32 * SIZE + column as u32) as usize)
    };
    on_mesh.owned().map(pixel).collect()
}

#[test]
fn a_models_own_maps_come_back_on_straight_and_on_mirrored_charts() {
    assert_comes_back(&folded().write());
}

#[test]
fn maps_of_another_uv_set_come_back_as_exactly() {
    let mut file = folded();
    file.picture_uvs = Some(file.quads.iter().map(|quad| quad.uvs).collect());
    assert_comes_back(&file.write());
}

fn assert_comes_back(mesh: &MadeMesh) {
    let mut on_mesh = OnMesh::new(GRAPH, mesh.path(), SIZE);
    assert_eq!(on_mesh.atlas().report.mirrored_charts, 1);
    let evaluated = on_mesh.evaluate("out");
    let color = ["base_color.r", "base_color.g", "base_color.b"].map(|name| evaluated.component(name));
    let normal = ["normal.x", "normal.y", "normal.z"].map(|name| evaluated.component(name));
    let pixels = pixels(&on_mesh);
    assert_eq!(pixels.len(), (SIZE * SIZE) as usize, "every pixel belongs to a face");
    let (colors, normals) = (colors(), normals());
    for (index, pixel) in pixels {
        for component in 0..3 {
            let was = colors[3 * pixel + component];
            let is = srgb8_from_linear(color[component][index]);
            assert_eq!(was, is, "base color of pixel {pixel}");

            let was = f64::from(normals[3 * pixel + component]) / 255.0;
            let is = 0.5 + 0.5 * f64::from(normal[component][index]);
            // The stored normal is not quite of unit length; its rounding is half a step in each component.
            assert!(
                (was - is).abs() < 1.0 / 255.0,
                "normal of pixel {pixel}: {was} became {is}"
            );
        }
    }
}
