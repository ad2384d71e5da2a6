//! Pictures on surfaces: every projection is compared with the picture itself.

use std::f64::consts::TAU;
use std::path::PathBuf;

use sabi_color::linear_from_srgb;
use sabi_image::{PngData, PngOptions, encode_exr, encode_png};
use sabi_tests::{MadeTexture, MeshFile, OnMesh, Quad, project};
use serde_json::{Value, json};
use tempfile::TempDir;

mod averaging;
mod reading;

const SIDE: u32 = 64;

/// Pictures in a folder of their own.
struct Folder(TempDir);

impl Folder {
    fn new() -> Folder {
        Folder(tempfile::tempdir().expect("a folder for pictures"))
    }

    /// Writes a file, and gives its path as a graph has it.
    fn write(&self, name: &str, bytes: Vec<u8>) -> String {
        let path: PathBuf = self.0.path().join(name);
        std::fs::write(&path, bytes).expect("a picture's file");
        path.to_string_lossy().into_owned()
    }
}

fn png(side: u32, channels: u8, srgb_chunk: bool, codes: &[u8]) -> Vec<u8> {
    let options = PngOptions {
        channels,
        bits: 8,
        srgb_chunk,
    };
    encode_png(side, side, PngData::U8(codes), options).expect("a picture")
}

fn graph(params: &Value) -> String {
    let nodes = json!({ "image": { "kind": "source/image", "params": params } });
    json!({ "format": "sabi", "version": 1, "fit": "metres", "nodes": nodes }).to_string()
}

/// A square of side 1 in the plane z = 0 whose texture fills it upright.
fn square() -> Quad {
    Quad {
        corners: [[-0.5, -0.5, 0.0], [0.5, -0.5, 0.0], [0.5, 0.5, 0.0], [-0.5, 0.5, 0.0]],
        uvs: [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]],
    }
}

fn on_square(params: &Value, size: u32) -> OnMesh {
    let made = MeshFile::new(vec![square()]).write();
    OnMesh::new(&graph(params), made.path(), size)
}

/// Pixel of the picture under each owned texel of a square as large as the picture.
fn pixels(on_mesh: &OnMesh, side: u32) -> Vec<(usize, usize)> {
    let pixel = |(index, triangle): (usize, u32)| {
        let chart = &on_mesh.atlas().charts[on_mesh.atlas().triangle_chart[triangle as usize] as usize];
        let [_, x, y] = on_mesh.texel(index);
        let [column, row] = [(x, 0), (y, 1)].map(|(at, axis)| at as i32 - chart.texel_from_uv[axis]);
        (index, (row as u32 * side + column as u32) as usize)
    };
    on_mesh.owned().map(pixel).collect()
}

/// Compares every texel of a result along UVs with the pixel under it.
fn assert_pixels(params: &Value, port: &str, component: &str, expected: impl Fn(usize) -> f32) {
    let mut on_mesh = on_square(params, SIDE);
    let values = on_mesh.evaluate(&format!("image.{port}")).component(component);
    for (index, pixel) in pixels(&on_mesh, SIDE) {
        let (is, expected) = (values[index], expected(pixel));
        // Colors are stored as half floats.
        assert!(
            (is - expected).abs() <= expected / 2048.0 + 1e-6,
            "{port} of pixel {pixel} with {params}: {is} for {expected}"
        );
    }
}

#[test]
fn along_uv_each_texel_is_its_pixel_in_the_color_space_that_is_meant() {
    let folder = Folder::new();
    let code = |at: u32| ((at * 31 + at / 97) % 256) as u8;
    let codes: Vec<u8> = (0..4 * SIDE * SIDE).map(code).collect();
    let unsaid = folder.write("unsaid.png", png(SIDE, 4, false, &codes));
    let plain = |code: u8| f32::from(code) / 255.0;
    let srgb = |code: u8| linear_from_srgb(plain(code));
    let code = |pixel: usize, at: usize| codes[4 * pixel + at];
    let gray = |pixel: usize, curve: &dyn Fn(u8) -> f32| {
        0.2126 * curve(code(pixel, 0)) + 0.7152 * curve(code(pixel, 1)) + 0.0722 * curve(code(pixel, 2))
    };
    let with = |space: &str| json!({ "file": unsaid, "color_space": space });
    assert_pixels(&with("auto"), "color", "color.r", |at| srgb(code(at, 0)));
    assert_pixels(&with("srgb"), "color", "color.g", |at| srgb(code(at, 1)));
    assert_pixels(&with("linear"), "color", "color.b", |at| plain(code(at, 2)));
    assert_pixels(&with("auto"), "mask", "mask", |at| gray(at, &plain));
    assert_pixels(&with("srgb"), "mask", "mask", |at| gray(at, &srgb));
    assert_pixels(&with("srgb"), "alpha", "mask", |at| plain(code(at, 3)));
    let floats: Vec<f32> = (0..SIDE * SIDE).map(|at| (at % 251) as f32 / 100.0).collect();
    let exr = encode_exr(SIDE, SIDE, &[("Y", &floats)], sabi_image::ExrSamples::Float).expect("a picture");
    let exr = json!({ "file": folder.write("data.exr", exr) });
    assert_pixels(&exr, "color", "color.r", |at| floats[at]);
    assert_pixels(&exr, "mask", "mask", |at| floats[at]);
    assert_pixels(&exr, "alpha", "mask", |_| 1.0);
}

/// A picture that repeats without a seam: `0.5 + 0.4 cos(2π u)` across in red, the same down in green.
fn waves(folder: &Folder) -> String {
    let wave = |at: u32| (255.0 * (0.5 + 0.4 * (TAU * (f64::from(at) + 0.5) / 256.0).cos())).round() as u8;
    let codes: Vec<u8> = (0..256 * 256_u32)
        .flat_map(|at| [wave(at % 256), wave(at / 256), 0])
        .collect();
    folder.write("waves.png", png(256, 3, false, &codes))
}

fn wave(u: f64) -> f64 {
    0.5 + 0.4 * (TAU * u).cos()
}

/// Largest error of the picture of a wave: half an 8-bit step, half floats, and the averaging over a texel.
const WAVE_TOLERANCE: f64 = 0.01;

#[test]
fn tiles_turns_and_moves_are_those_of_the_picture() {
    let folder = Folder::new();
    let file = waves(&folder);
    // Texture coordinates with v upward, from the middle; then tiles to the right and up.
    type Place = fn(f64, f64) -> [f64; 2];
    let cases: [(Value, Place); 5] = [
        (json!({}), |x, y| [x, y]),
        (json!({ "tiles": [2, 1] }), |x, y| [2.0 * x + 0.5, y]),
        (json!({ "rotate": 90 }), |x, y| [y, -x]),
        (json!({ "rotate": 30 }), |x, y| {
            let (sin, cos) = 30.0_f64.to_radians().sin_cos();
            [cos * x + sin * y, cos * y - sin * x]
        }),
        (json!({ "offset": [0.25, 0.1] }), |x, y| [x - 0.25, y - 0.1]),
    ];
    for (mut params, place) in cases {
        params["file"] = json!(file);
        params["color_space"] = json!("linear");
        let mut on_mesh = on_square(&params, 128);
        let color = on_mesh.evaluate("image.color");
        let [red, green] = ["color.r", "color.g"].map(|name| color.component(name));
        for (index, _) in on_mesh.owned() {
            let at = on_mesh.position(index).expect("a place");
            let [right, up] = place(at.x, at.y);
            let (across, down) = (wave(right + 0.5), wave(0.5 - up));
            let off = (f64::from(red[index]) - across)
                .abs()
                .max((f64::from(green[index]) - down).abs());
            assert!(off < WAVE_TOLERANCE, "{params} at {at}: off by {off}");
        }
    }
}

#[test]
fn triplanar_is_a_blend_of_three_pictures_by_the_normal_and_knows_no_seam() {
    let folder = Folder::new();
    let (size, sharpness) = (0.7, 8.0);
    let params = json!({
        "file": waves(&folder), "color_space": "linear", "projection": "triplanar", "size": size, "sharpness": sharpness,
    });
    let mut on_mesh = OnMesh::new(&graph(&params), &project("assets/meshes/sphere.glb"), 128);
    let color = on_mesh.evaluate("image.color");
    let [red, green] = ["color.r", "color.g"].map(|name| color.component(name));
    let mut checked = 0;
    for (index, triangle) in on_mesh.owned() {
        let at = on_mesh.position(index).expect("a place");
        let [_, x, y] = on_mesh.texel(index);
        let here = glam::dvec2(f64::from(x) + 0.5, f64::from(y) + 0.5);
        let normal = on_mesh.frame_at(triangle, here)[2].normalize();
        let weights = normal.abs().to_array().map(|part| part.powf(sharpness));
        let sum: f64 = weights.iter().sum();
        let side = normal.signum();
        // Right and up of each picture, seen from outside.
        let seen = [[-side.x * at.z, at.y], [side.y * at.x, -at.z], [side.z * at.x, at.y]];
        let mut expected = [0.0; 2];
        for (weight, [right, up]) in weights.into_iter().zip(seen) {
            expected[0] += weight / sum * wave(right / size + 0.5);
            expected[1] += weight / sum * wave(0.5 - up / size);
        }
        let off = (f64::from(red[index]) - expected[0])
            .abs()
            .max((f64::from(green[index]) - expected[1]).abs());
        assert!(off < 2.0 * WAVE_TOLERANCE, "at {at}: off by {off}");
        checked += 1;
    }
    assert!(checked > 1000);
}

/// A normal map of the height `depth · cos(2π u) / 2π` over a tile, with `u` to the right, or upward.
fn normal_map(folder: &Folder, depth: f64, is_upward: bool, is_flipped: bool) -> String {
    let pixel = |at: u32| {
        let along = if is_upward { 255 - at / 256 } else { at % 256 };
        let steep = -depth * (TAU * (f64::from(along) + 0.5) / 256.0).sin();
        let [x, y] = if is_upward { [0.0, -steep] } else { [-steep, 0.0] };
        let length = (1.0 + steep * steep).sqrt();
        let y = if is_flipped { -y } else { y };
        [x, y, 1.0].map(|part| (255.0 * (0.5 + 0.5 * part / length)).round() as u8)
    };
    let codes: Vec<u8> = (0..256 * 256).flat_map(pixel).collect();
    folder.write(
        &format!("normal_{is_upward}_{is_flipped}.png"),
        png(256, 3, false, &codes),
    )
}

#[test]
fn the_slope_of_a_normal_map_is_the_gradient_of_its_height_in_every_projection() {
    let folder = Folder::new();
    let depth = 0.4;
    for (projection, is_upward, is_down, rotate) in [
        ("uv", false, false, 0.0),
        ("uv", true, false, 0.0),
        ("uv", true, true, 0.0),
        ("uv", true, false, 35.0),
        ("triplanar", false, false, 0.0),
        ("triplanar", true, true, 35.0),
        ("decal", false, false, 35.0),
        ("decal", true, false, 0.0),
    ] {
        let params = json!({
            "file": normal_map(&folder, depth, is_upward, is_down), "projection": projection, "size": 1, "rotate": rotate,
            "normal_y": if is_down { "down" } else { "up" },
        });
        let mut on_mesh = on_square(&params, 128);
        let slope = on_mesh.evaluate("image.slope");
        let slope = ["vector.x", "vector.y", "vector.z"].map(|name| slope.component(name));
        let (sin, cos) = f64::to_radians(rotate).sin_cos();
        let along = if is_upward { [-sin, cos] } else { [cos, sin] };
        for (index, _) in on_mesh.owned() {
            let at = on_mesh.position(index).expect("a place");
            // The decal ends at the border of the square where it is rotated.
            if at.x.abs().max(at.y.abs()) > 0.3 {
                continue;
            }
            let height = -depth * (TAU * (at.x * along[0] + at.y * along[1] + 0.5)).sin();
            let expected = [height * along[0], height * along[1], 0.0];
            for axis in 0..3 {
                let off = (f64::from(slope[axis][index]) - expected[axis]).abs();
                // An 8-bit normal is good to a 255th, and the flat one is no code.
                assert!(off < 0.012, "{params} at {at}: slope {axis} is off by {off}");
            }
        }
    }
}

#[test]
fn along_uv_a_normal_map_has_the_slope_that_the_model_gives_it() {
    let folder = Folder::new();
    let file = normal_map(&folder, 0.4, true, false);
    let mut mirrored = square();
    mirrored.uvs = [[0.9, 0.8], [0.1, 0.7], [0.2, 0.1], [0.8, 0.2]];
    let made = MeshFile {
        quads: vec![mirrored],
        textures: vec![MadeTexture {
            slot: "/normalTexture",
            png: std::fs::read(&file).expect("the picture"),
            info: json!({}),
            sampler: json!({}),
        }],
        ..MeshFile::default()
    };
    let nodes = json!({
        "image": { "kind": "source/image", "params": { "file": file } }, "model": { "kind": "source/model" },
    });
    let graph = json!({ "format": "sabi", "version": 1, "nodes": nodes }).to_string();
    let mut on_mesh = OnMesh::new(&graph, made.write().path(), 64);
    let [image, model] = ["image.slope", "model.slope"].map(|port| on_mesh.evaluate(port));
    for component in ["vector.x", "vector.y", "vector.z"] {
        let [image, model] = [&image, &model].map(|slope| slope.component(component));
        // Texture coordinates are rounded on two ways, and slopes reach 0.4.
        let off = image.iter().zip(&model).map(|(image, model)| (image - model).abs());
        let most = off.fold(0.0_f32, f32::max);
        assert!(most < 2e-6, "{component}: {most}");
    }
}

/// Parameters, a place on the square, and alpha and mask there.
fn decal_cases() -> Vec<(Value, [f64; 2], [f32; 2], &'static str)> {
    vec![
        (json!({}), [-0.1, 0.1], [1.0, 1.0], "upper left"),
        (json!({}), [0.1, 0.1], [1.0, 0.0], "upper right"),
        (json!({}), [-0.1, -0.1], [1.0, 0.0], "lower left"),
        (json!({}), [-0.3, 0.3], [0.0, 0.0], "beside it"),
        (json!({ "rotate": -90 }), [0.1, 0.1], [1.0, 1.0], "turned clockwise"),
        (
            json!({ "up": [1, 0, 0] }),
            [0.1, 0.1],
            [1.0, 1.0],
            "upper side to the right",
        ),
        (json!({ "position": [0.2, 0, 0] }), [0.1, 0.1], [1.0, 1.0], "moved"),
        (
            json!({ "position": [0, 0, 0.2] }),
            [-0.1, 0.1],
            [1.0, 1.0],
            "before the surface",
        ),
        (
            json!({ "position": [0, 0, 0.3] }),
            [-0.1, 0.1],
            [0.0, 0.0],
            "too far before it",
        ),
        (json!({ "toward": [0, 0, -1] }), [-0.1, 0.1], [0.0, 0.0], "from behind"),
        (
            json!({ "toward": [0, 0, -1], "facing": 180, "depth": 1 }),
            [0.1, 0.1],
            [0.0, 0.0],
            "just behind the limit",
        ),
        (
            json!({ "toward": [1, 0, 0.1], "facing": 60 }),
            [0.0, 0.0],
            [0.0, 0.0],
            "too slanted",
        ),
        (json!({ "size": 1.0 }), [-0.3, 0.3], [1.0, 1.0], "larger"),
    ]
}

#[test]
fn a_decal_lies_where_it_is_put_and_nowhere_else() {
    let folder = Folder::new();
    // The upper left quarter is white, the rest black; opaque.
    let codes: Vec<u8> = (0..SIDE * SIDE)
        .map(|at| {
            if at % SIDE < SIDE / 2 && at / SIDE < SIDE / 2 {
                255
            } else {
                0
            }
        })
        .collect();
    let file = folder.write("quarter.png", png(SIDE, 1, false, &codes));
    for (mut params, place, expected, what) in decal_cases() {
        params["file"] = json!(file);
        params["projection"] = json!("decal");
        params["size"] = params.get("size").cloned().unwrap_or(json!(0.5));
        let mut on_mesh = on_square(&params, SIDE);
        let found = ["image.alpha", "image.mask"].map(|port| on_mesh.evaluate(port).component("mask"));
        let distance = |index: usize| {
            let at = on_mesh.position(index).expect("a place");
            (at.x - place[0]).hypot(at.y - place[1])
        };
        let nearest = on_mesh
            .owned()
            .map(|(index, _)| index)
            .min_by(|a, b| distance(*a).total_cmp(&distance(*b)));
        let nearest = nearest.expect("a texel");
        for (values, expected) in found.iter().zip(expected) {
            // White is 1 up to the rounding of its luminance.
            assert!(
                (values[nearest] - expected).abs() < 1e-6,
                "{what}: {} for {expected}",
                values[nearest]
            );
        }
    }
}
