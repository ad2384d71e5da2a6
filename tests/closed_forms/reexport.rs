//! `source/model → output/material` gives back the maps that the model came with.

use sabi_color::srgb8_from_linear;
use sabi_image::{PngData, PngOptions, encode_png};
use sabi_tests::{MadeMesh, MadeTexture, MeshFile, OnMesh, Quad};
use serde_json::{Value, json};

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
fn faces() -> Vec<Quad> {
    let upright = Quad {
        corners: [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.5, 0.0], [0.0, 0.5, 0.0]],
        uvs: [[0.0, 0.5], [1.0, 0.5], [1.0, 0.0], [0.0, 0.0]],
    };
    let mirrored = Quad {
        corners: [[0.0, 0.0, 0.5], [1.0, 0.0, 0.5], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]],
        uvs: [[1.0, 1.0], [0.0, 1.0], [0.0, 0.5], [1.0, 0.5]],
    };
    vec![upright, mirrored]
}

fn folded() -> MeshFile {
    MeshFile {
        quads: faces(),
        base_color: Some(png(&colors())),
        normal: Some(png(&normals())),
        ..MeshFile::default()
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

/// Placement of a texture on the model, and the function from a pixel of the unit square to the pixel of the texture there.
struct TexturePlacement {
    name: &'static str,
    transform: Value,
    sampler: Value,
    source: fn(u32, u32) -> (u32, u32),
}

/// glTF's names of the wraps.
const CLAMP: u32 = 33071;
const MIRROR: u32 = 33648;

fn placings() -> [TexturePlacement; 4] {
    let offset = |u: f64, v: f64| json!({ "offset": [u, v] });
    [
        TexturePlacement {
            name: "as it is",
            transform: Value::Null,
            sampler: json!({}),
            source: |x, y| (x, y),
        },
        TexturePlacement {
            name: "moved, repeating",
            transform: offset(0.25, 0.5),
            sampler: json!({}),
            source: |x, y| ((x + SIZE / 4) % SIZE, (y + SIZE / 2) % SIZE),
        },
        TexturePlacement {
            name: "moved, mirrored across and clamped down",
            transform: offset(0.5, 0.5),
            sampler: json!({ "wrapS": MIRROR, "wrapT": CLAMP }),
            source: |x, y| {
                let across = x + SIZE / 2;
                let mirrored = if across < SIZE { across } else { 2 * SIZE - 1 - across };
                (mirrored, (y + SIZE / 2).min(SIZE - 1))
            },
        },
        TexturePlacement {
            name: "turned by a right angle",
            transform: json!({ "rotation": std::f64::consts::FRAC_PI_2 }),
            sampler: json!({}),
            // u becomes v, and v becomes -u.
            source: |x, y| (y, SIZE - 1 - x),
        },
    ]
}

/// A picture of four channels that differs for each seed.
fn rgba(seed: u32) -> Vec<u8> {
    let code = |at: u32| ((at * 37 + seed * 101 + (at / 7) * (seed + 3)) % 256) as u8;
    (0..4 * SIZE * SIZE).map(code).collect()
}

fn png_rgba(codes: &[u8]) -> Vec<u8> {
    let options = PngOptions {
        channels: 4,
        bits: 8,
        srgb_chunk: false,
    };
    encode_png(SIZE, SIZE, PngData::U8(codes), options).expect("a picture")
}

/// A model whose every map lies the same way, with a factor on each.
fn mapped(placing: &TexturePlacement) -> MadeMesh {
    let texture = |slot: &'static str, seed: u32, more: Value| {
        let mut info = more;
        if !placing.transform.is_null() {
            info["extensions"]["KHR_texture_transform"] = placing.transform.clone();
        }
        MadeTexture {
            slot,
            png: png_rgba(&rgba(seed)),
            info,
            sampler: placing.sampler.clone(),
        }
    };
    MeshFile {
        quads: faces(),
        textures: vec![
            texture("/pbrMetallicRoughness/baseColorTexture", 1, json!({})),
            texture("/pbrMetallicRoughness/metallicRoughnessTexture", 2, json!({})),
            texture("/occlusionTexture", 3, json!({ "strength": 0.5 })),
            texture("/emissiveTexture", 4, json!({})),
        ],
        factors: json!({
            "pbrMetallicRoughness": {
                "baseColorFactor": [1.0, 0.5, 0.25, 0.75], "roughnessFactor": 0.8, "metallicFactor": 0.6,
            },
            "emissiveFactor": [1.0, 0.5, 1.0],
            "extensions": { "KHR_materials_emissive_strength": { "emissiveStrength": 0.5 } },
            "alphaMode": "BLEND",
        }),
        ..MeshFile::default()
    }
    .write()
}

/// Value that a code of a picture stands for.
type ExpectedValue<'a> = &'a dyn Fn(u8) -> f64;

#[test]
fn every_map_of_a_model_comes_back_however_it_wraps_and_is_transformed() {
    let plain = |code: u8| f64::from(code) / 255.0;
    let srgb = |code: u8| f64::from(sabi_color::linear_from_srgb(f32::from(code) / 255.0));
    for placing in placings() {
        let made = mapped(&placing);
        let mut on_mesh = OnMesh::new(GRAPH, made.path(), SIZE);
        let evaluated = on_mesh.evaluate("out");
        let maps: [(&str, u32, usize, ExpectedValue<'_>); 10] = [
            ("base_color.r", 1, 0, &srgb),
            ("base_color.g", 1, 1, &|code| 0.5 * srgb(code)),
            ("base_color.b", 1, 2, &|code| 0.25 * srgb(code)),
            ("alpha", 1, 3, &|code| 0.75 * plain(code)),
            ("roughness", 2, 1, &|code| 0.8 * plain(code)),
            ("metallic", 2, 2, &|code| 0.6 * plain(code)),
            ("occlusion", 3, 0, &|code| 1.0 + 0.5 * (plain(code) - 1.0)),
            ("emission.r", 4, 0, &|code| 0.5 * srgb(code)),
            ("emission.g", 4, 1, &|code| 0.25 * srgb(code)),
            ("emission.b", 4, 2, &|code| 0.5 * srgb(code)),
        ];
        for (name, seed, component, expected) in maps {
            let (codes, values) = (rgba(seed), evaluated.component(name));
            for (index, pixel) in pixels(&on_mesh) {
                let (x, y) = (placing.source)(pixel as u32 % SIZE, pixel as u32 / SIZE);
                let expected = expected(codes[4 * (y * SIZE + x) as usize + component]);
                let is = f64::from(values[index]);
                // Stored as half floats: half a unit in the eleventh place, an eighth of an 8-bit step at most. Pictures in sRGB
                // are held as half floats as well, which the factor of alpha alone does not leave as they are.
                let roundings = if name == "alpha" { 2.0 } else { 1.0 };
                assert!(
                    (is - expected).abs() <= roundings * expected / 2048.0 + 1e-6,
                    "{name} of pixel {pixel}, {}: {expected} became {is}",
                    placing.name
                );
            }
        }
    }
}
