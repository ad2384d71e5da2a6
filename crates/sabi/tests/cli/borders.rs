//! Borders of charts in written maps, which contain nothing of a neighboring material, part or color; and UVs that repeat
//! or are in several tiles.

use sabi_image::{Pixels, decode};
use serde_json::Value as Json;

use crate::cli_folder::CliFolder;

/// Every source whose data is read by triangle, with an output for each.
const SOURCES: &str = r#"    "model": { "kind": "source/model" },
    "colors": { "kind": "source/vertex_color" },
    "parts": { "kind": "surface/id" },
    "facing": { "kind": "surface/normal" },
    "out": { "kind": "output/material", "inputs": { "material": "model.material" } },
    "out_vertex": { "kind": "output/color", "params": { "name": "vertex" }, "inputs": { "source": "colors.color" } },
    "out_part": { "kind": "output/color", "params": { "name": "part" }, "inputs": { "source": "parts.color" } },
    "out_random": { "kind": "output/mask", "params": { "name": "random" }, "inputs": { "source": "parts.id" } },
    "out_normal": { "kind": "output/vector", "params": { "name": "facing" }, "inputs": { "source": "facing.normal" } },
    "out_own": { "kind": "output/color", "params": { "name": "own" }, "inputs": { "source": "model.base_color" } }"#;

fn sources() -> String {
    format!("{{ \"format\": \"sabi\", \"version\": 1, \"nodes\": {{\n{SOURCES}\n}} }}")
}

/// Two squares that meet at a right angle, each a part with a vertex color and a material, with UVs apart from each other.
fn fold(materials: [&str; 2]) -> String {
    let square = |name: &str, material: &str, color: &str, corners: [&str; 4], u: [f32; 2], first: u32| {
        let vertices: String = corners.iter().map(|corner| format!("v {corner} {color}\n")).collect();
        let [left, right] = u;
        let uvs = format!("vt {left} 0.2\nvt {right} 0.2\nvt {right} 0.8\nvt {left} 0.8\n");
        let ids: Vec<String> = (first..first + 4).map(|id| format!("{id}/{id}")).collect();
        format!("o {name}\n{vertices}{uvs}usemtl {material}\nf {}\n", ids.join(" "))
    };
    let flat = ["0 0 0", "1 0 0", "1 1 0", "0 1 0"];
    let upright = ["1 0 0", "1 0 -1", "1 1 -1", "1 1 0"];
    let one = square("one", materials[0], "0.9 0.1 0.2", flat, [0.05, 0.35], 1);
    let other = square("other", materials[1], "0.1 0.3 0.8", upright, [0.65, 0.95], 5);
    format!("mtllib fold.mtl\n{one}{other}")
}

const MATERIALS: &str =
    "newmtl red\nKd 1 0 0\nPm 1\nPr 0.2\nnewmtl blue\nKd 0 0 1\nPm 0\nPr 0.9\nnewmtl plain\nKd 1 1 1\n";

/// Returns the pixels of a map as integers, each with its channels.
fn codes(place: &CliFolder, file: &str) -> (u32, Vec<Vec<u16>>) {
    let image = decode(file, &place.read(file)).unwrap();
    let channels = usize::from(image.channels);
    let values: Vec<u16> = match image.pixels {
        Pixels::U8(codes) => codes.into_iter().map(u16::from).collect(),
        Pixels::U16(codes) => codes,
        Pixels::F32(_) => panic!("{file} has codes"),
    };
    (
        image.width,
        values.chunks_exact(channels).map(<[u16]>::to_vec).collect(),
    )
}

/// Maps that a report lists, as PNG.
fn pictures(report: &Json) -> Vec<String> {
    let outputs = report["outputs"].as_array().unwrap().iter();
    let paths = outputs.map(|output| output["path"].as_str().unwrap().to_owned());
    paths.filter(|path| path.ends_with(".png")).collect()
}

/// Bakes all maps of the fold and some of its mesh, with padding everywhere; also returns the names of the files.
fn baked(materials: [&str; 2], mesh_maps: &[&str]) -> (CliFolder, Vec<String>) {
    let place = CliFolder::new();
    place.write("fold.obj", fold(materials));
    place.write("fold.mtl", MATERIALS);
    place.write("sources.sabi", sources());
    let mut arguments = vec!["--all-maps", "--padding", "infinite", "--json"];
    arguments.extend(mesh_maps.iter().flat_map(|map| ["--mesh-map", map]));
    let run = place.bake("sources.sabi", "fold.obj", &arguments).good();
    let report: Json = serde_json::from_str(&run.stdout).unwrap();
    let files = pictures(&report);
    (place, files)
}

#[test]
fn no_map_has_a_texel_of_the_neighboring_part_or_color() {
    let (place, files) = baked(["plain", "plain"], &["id", "world_normal"]);
    for name in ["vertex", "part", "random", "id", "world_normal"] {
        let file = files.iter().find(|file| file.ends_with(&format!("_{name}.png")));
        let file = file.unwrap_or_else(|| panic!("{name}: {files:?}"));
        let (width, pixels) = codes(&place, &format!("out/{file}"));
        let at = |x: u32, y: u32| &pixels[(y * width + x) as usize];
        let sides = [at(width / 5, width / 2), at(4 * width / 5, width / 2)];
        assert_ne!(sides[0], sides[1], "{name}: the sides differ");
        for y in 0..width {
            for x in 0..width {
                // The charts are as far from the left border as from the right one, so their padding meets in the middle.
                assert_eq!(at(x, y), sides[usize::from(x >= width / 2)], "{name} at {x} {y}");
            }
        }
    }
}

#[test]
fn no_map_of_a_material_has_a_texel_of_the_neighboring_one() {
    let (place, files) = baked(["red", "blue"], &["material_id"]);
    let own = [
        "red_own.png",
        "blue_own.png",
        "red_material_id.png",
        "blue_material_id.png",
        "red_metallic.png",
        "blue_roughness.png",
    ];
    for file in own {
        assert!(files.iter().any(|known| known == file), "{file}: {files:?}");
        let (width, pixels) = codes(&place, &format!("out/{file}"));
        let column = if file.starts_with("red") {
            width / 5
        } else {
            4 * width / 5
        };
        let expected = &pixels[(width / 2 * width + column) as usize];
        assert!(pixels.iter().all(|pixel| pixel == expected), "{file}");
    }
}

/// Returns squares beside each other in space, each with its lower UV corner and its side.
fn squares(places: &[([f32; 2], f32)]) -> String {
    let square = |(index, ([u, v], side)): (usize, &([f32; 2], f32))| {
        let first = 4 * index + 1;
        let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let vertices = corners.map(|[x, y]| {
            format!(
                "v {} {y} 0\nvt {} {}\n",
                2.0 * index as f32 + x,
                u + x * side,
                v + y * side
            )
        });
        let ids: Vec<String> = (first..first + 4).map(|id| format!("{id}/{id}")).collect();
        format!("{}f {}\n", vertices.concat(), ids.join(" "))
    };
    let all: String = places.iter().enumerate().map(square).collect();
    format!("usemtl wood\n{all}")
}

#[test]
fn two_equal_bolts_in_two_tiles_leave_a_model_its_tiles() {
    let place = CliFolder::new();
    let bolts = [
        ([0.1, 0.1], 0.5),
        ([0.8, 0.8], 0.1),
        ([1.2, 0.1], 0.5),
        ([1.8, 0.8], 0.1),
        ([2.1, 0.3], 0.4),
    ];
    place.write("bolts.obj", squares(&bolts));
    place.bake("rust.sabi", "bolts.obj", &[]).good();
    let maps = place.listing("out");
    for tile in ["1001", "1002", "1003"] {
        assert!(maps.contains(&format!("wood_base_color.{tile}.png")), "{maps:?}");
    }
}

#[test]
fn a_model_in_tiles_is_described_tile_by_tile_as_a_bake_takes_it() {
    let place = CliFolder::new();
    let bolts = [
        ([0.1, 0.1], 0.5),
        ([0.8, 0.8], 0.1),
        ([1.2, 0.1], 0.5),
        ([1.8, 0.8], 0.1),
        ([1.8, 0.8], 0.1),
        ([2.1, 0.3], 0.4),
    ];
    place.write("bolts.obj", squares(&bolts));
    let described = |more: &[&str]| -> Json {
        let run = place.sabi(&[&["mesh", "bolts.obj", "--json"], more].concat()).good();
        serde_json::from_str(&run.stdout).unwrap()
    };
    let of_sets = |report: &Json| -> Vec<(Option<u64>, u64, u64)> {
        let sets = report["sets"].as_array().unwrap().iter();
        sets.map(|set| {
            assert_eq!(set["material"], "wood");
            let pairs = ["stacked", "mirrored", "tiling", "partial"];
            let pairs = pairs.map(|kind| set["overlap"][kind].as_u64().unwrap());
            (
                set["udim"].as_u64(),
                set["charts"].as_u64().unwrap(),
                pairs.iter().sum(),
            )
        })
        .collect()
    };
    // Two bolts lie on each other in the second tile.
    let report = described(&[]);
    assert_eq!(
        of_sets(&report),
        [(Some(1001), 2, 0), (Some(1002), 3, 1), (Some(1003), 1, 0)]
    );
    assert_eq!(report["overlapping_charts"], 1, "{report:#}");
    assert_eq!(
        (&report["overlap"]["stacked"], &report["overlap"]["tiling"]),
        (&1.into(), &0.into())
    );
    let folded = described(&["--udim", "off"]);
    assert_eq!(of_sets(&folded).len(), 1);
    let texels = |report: &Json| report["overlap"]["texels"].as_u64().unwrap();
    assert!(texels(&folded) > 10 * texels(&report), "tiles share no place");
    let table = place.sabi(&["mesh", "bolts.obj"]).good().stdout;
    let row = table.lines().find(|line| line.starts_with("texture sets")).unwrap();
    assert!(
        row.contains("wood.1002 (charts 3, covered 27 %, overlapping pairs 1)"),
        "{row}"
    );
}

#[test]
fn tiles_that_are_taken_for_a_texture_that_repeats_are_told_with_the_way_out() {
    let place = CliFolder::new();
    place.write(
        "alike.obj",
        squares(&[([0.1, 0.1], 0.5), ([1.1, 0.1], 0.5), ([2.2, 0.3], 0.3)]),
    );
    let told = place.sabi(&["mesh", "alike.obj"]).good();
    let words = "the UVs of 'wood' lie in 3 tiles, which share one set of maps, since most of them lie alike in several tiles; make maps \
                 for each UV tile with --udim on";
    assert!(told.stderr.contains(words), "{}", told.stderr);
    for udim in ["on", "off"] {
        let told = place.sabi(&["mesh", "alike.obj", "--udim", udim]).good();
        assert!(!told.stderr.contains("share one set of maps"), "{}", told.stderr);
    }
}

#[test]
fn udim_that_is_asked_for_is_refused_where_a_tile_has_no_number() {
    let place = CliFolder::new();
    place.write("left.obj", squares(&[([0.1, 0.1], 0.5), ([-0.8, 0.1], 0.6)]));
    place.refuses(
        "rust.sabi",
        "left.obj",
        &["--udim", "on"],
        65,
        "left.obj: a UV chart (the one with triangle 2) lies in the UV tile with u from -1 to 0 and v, counted upward, from 0 to 1, which \
         has no UDIM number: those have u from 0 to 10, and v from 0 to 900; change the UVs in a modeling program, or take the UV tiles for \
         a texture that repeats with --udim off",
    );
    place.bake("rust.sabi", "left.obj", &[]).good();
}

#[test]
fn a_surface_whose_uvs_repeat_often_is_unwrapped_unless_its_own_uvs_are_kept() {
    let place = CliFolder::new();
    place.write("brick.obj", squares(&[([0.0, 0.0], 5.0), ([-3.0, 2.0], 2.0)]));
    let run = place.sabi(&["mesh", "brick.obj", "--json", "--no-cache"]).good();
    let report: Json = serde_json::from_str(&run.stdout).unwrap();
    assert_eq!(report["overlap"]["texels"], 0, "{report:#}");
    assert_eq!(report["unwrapped"]["pieces"], 2);
    let words = "the UVs of 'wood' repeat so often that they cover the area of a map 29 times, and a map has one value for all places that \
                 share a texel; so the surface was unwrapped onto a sheet of its own, and the maps fit the UVs that a copy of the model \
                 gets, not its own; keep the model's own UVs with --overlap first";
    assert!(run.stderr.contains(words), "{}", run.stderr);
    for overlap in ["first", "merge"] {
        let run = place
            .sabi(&["mesh", "brick.obj", "--json", "--overlap", overlap])
            .good();
        let report: Json = serde_json::from_str(&run.stdout).unwrap();
        assert_eq!(report["unwrapped"], Json::Null);
        assert!(
            run.stderr.contains("unwrap the model with --overlap unwrap"),
            "{}",
            run.stderr
        );
    }
    let copied = place.bake("rust.sabi", "brick.obj", &["--model"]).good();
    assert!(copied.stderr.contains(words), "{}", copied.stderr);
    assert!(place.listing("out").contains(&"brick.glb".to_owned()));
}
