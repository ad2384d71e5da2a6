//! Pictures that a graph names: their paths, and errors if they cannot be read.

use crate::bad_archives::crc32;
use crate::cli_folder::{CliFolder, graph};

/// Returns a picture of 2 by 2 pixels, all with the same gray.
fn bmp(gray: u8) -> Vec<u8> {
    let mut bytes = b"BM".to_vec();
    for word in [70_u32, 0, 54, 40, 2, 2, 1 | 24 << 16, 0, 16, 2835, 2835, 0, 0] {
        bytes.extend(word.to_le_bytes());
    }
    // Two rows of two pixels, each filled up to four bytes.
    bytes.extend([gray, gray, gray, gray, gray, gray, 0, 0].repeat(2));
    bytes
}

fn image(file: &str) -> String {
    graph(&format!(
        r#""img": {{ "kind": "source/image", "params": {{ "file": "{file}" }} }},
    "out": {{ "kind": "output/mask", "inputs": {{ "source": "img.mask" }} }}"#
    ))
    .replace("clouds.", "img.")
}

/// Returns the value of a constant map.
fn constant(place: &CliFolder, graph: &str, more: &[&str]) -> f64 {
    let run = place
        .bake(graph, "cube.glb", &[more, &["--json", "--force"]].concat())
        .good();
    let report: serde_json::Value = serde_json::from_str(&run.stdout).unwrap();
    report["constants"][0]["value"]
        .as_f64()
        .unwrap_or_else(|| panic!("{report:#}"))
}

#[test]
fn a_picture_is_found_from_the_file_that_names_it() {
    let place = CliFolder::new();
    std::fs::create_dir_all(place.path("group/art")).unwrap();
    place.write("plain.bmp", bmp(51));
    place.write("group/art/inner.bmp", bmp(102));
    place.write("absolute.bmp", bmp(153));
    place.write("beside.sabi", image("plain.bmp"));
    assert!((constant(&place, "beside.sabi", &[]) - 0.2).abs() < 1e-3);
    let absolute = place.path("absolute.bmp").to_string_lossy().replace('\\', "/");
    let set = format!("img.file={absolute}");
    assert!((constant(&place, "beside.sabi", &["--set", &set]) - 0.6).abs() < 1e-3);
    let inner = r#"{ "format": "sabi", "version": 1, "outputs": { "wear": "img.mask" }, "nodes": {
        "img": { "kind": "source/image", "params": { "file": "art/inner.bmp" } } } }"#;
    place.write("group/worn.sabi", inner);
    let outer = r#"{ "format": "sabi", "version": 1, "nodes": {
        "g": { "kind": "graph/group", "group": "group/worn.sabi" },
        "out": { "kind": "output/mask", "inputs": { "source": "g.wear" } } } }"#;
    place.write("outer.sabi", outer);
    assert!((constant(&place, "outer.sabi", &[]) - 0.4).abs() < 1e-3);
}

#[test]
fn a_picture_that_cannot_be_had_is_named_with_node_path_and_advice() {
    let place = CliFolder::new();
    place.write("damaged.bmp", &bmp(9)[..60]);
    place.write("text.png", "no picture");
    let words = |file: &str| match file {
        "" => "no picture is chosen; give the path of one, relative to the file that the node is in".to_owned(),
        "." => ". is a folder; give the path of a picture in it".to_owned(),
        "gone.png" => "there is no file gone.png; check the path, relative to the file that the node is in".to_owned(),
        "text.png" => {
            "text.png is no picture of a known kind, which Sabi does not read; save it as PNG, JPEG, WebP, TGA, \
                       BMP, HDR or OpenEXR and use that file"
                .to_owned()
        }
        other => panic!("{other}"),
    };
    for (file, code) in [("", 66), (".", 66), ("gone.png", 66), ("text.png", 65)] {
        place.write("image.sabi", image(file));
        let run = place.bake("image.sabi", "cube.glb", &[]).fails(code);
        let told = format!("parameter 'file' of node 'img' (source/image): {}", words(file));
        assert!(run.stderr.starts_with("error: image.sabi:"), "{}", run.stderr);
        assert!(run.stderr.trim_end().ends_with(&told), "{}", run.stderr);
        assert!(!place.path("out").exists());
        let check = place.sabi(&["check", "image.sabi"]).fails(65);
        assert!(format!("{}{}", check.stdout, check.stderr).contains(&told), "{check:?}");
    }
    place.write("image.sabi", image("damaged.bmp"));
    let run = place.bake("image.sabi", "cube.glb", &[]).fails(65);
    assert!(
        run.stderr.contains("damaged.bmp is a damaged BMP file"),
        "{}",
        run.stderr
    );
}

/// Reading a pipe would block, and a device may never end; this device is empty.
#[test]
#[cfg(unix)]
fn a_device_is_no_picture_and_no_group() {
    let place = CliFolder::new();
    place.write("image.sabi", image("/dev/null"));
    let check = place.sabi(&["check", "image.sabi"]).fails(65);
    let words = "/dev/null is a device or a pipe, which files never open";
    assert!(format!("{}{}", check.stdout, check.stderr).contains(words), "{check:?}");
    std::os::unix::fs::symlink("/dev/null", place.path("null.sabi")).unwrap();
    let group =
        r#"{ "format": "sabi", "version": 1, "nodes": { "g": { "kind": "graph/group", "group": "null.sabi" } } }"#;
    place.write("group.sabi", group);
    let check = place.sabi(&["check", "group.sabi"]).fails(66);
    assert!(check.stderr.contains(words), "{check:?}");
}

#[test]
fn a_picture_that_is_read_is_never_written_over() {
    let place = CliFolder::new();
    let texture = bmp(77);
    place.write("cube_mask.png", &texture);
    place.write("image.sabi", image("cube_mask.png"));
    let all = ["-o", ".", "--force", "--all-maps"];
    let run = place.bake("image.sabi", "cube.glb", &all).fails(73);
    let words = "cube_mask.png is read by this very bake and would be replaced by its own result; choose another folder with -o";
    assert!(run.stderr.trim_end().ends_with(words), "{}", run.stderr);
    assert_eq!(place.read("cube_mask.png"), texture);
    let report = ["--force", "--report", "cube_mask.png"];
    let run = place.bake("image.sabi", "cube.glb", &report).fails(73);
    let words = "cannot write the report cube_mask.png: this very bake reads it; name another file";
    assert!(run.stderr.trim_end().ends_with(words), "{}", run.stderr);
    assert_eq!(place.read("cube_mask.png"), texture);
}

#[test]
fn a_layer_of_an_openexr_file_is_chosen_by_rule_or_by_name() {
    let place = CliFolder::new();
    let pixel = |value: f32| vec![value; 4];
    let (beauty, mask, depth) = (pixel(0.8), pixel(0.25), pixel(0.5));
    let channels: [(&str, &[f32]); 7] = [
        ("albedo.B", &mask),
        ("albedo.G", &mask),
        ("albedo.R", &mask),
        ("beauty.B", &beauty),
        ("beauty.G", &beauty),
        ("beauty.R", &beauty),
        ("depth.Z", &depth),
    ];
    let exr = sabi_image::encode_exr(2, 2, &channels, sabi_image::ExrSamples::Float).unwrap();
    place.write("layers.exr", exr);
    place.write("image.sabi", image("layers.exr"));
    assert!((constant(&place, "image.sabi", &[]) - 0.8).abs() < 1e-3);
    for (layer, value) in [("albedo", 0.25), ("Beauty", 0.8), ("depth", 0.5)] {
        let set = format!("img.layer={layer}");
        assert!(
            (constant(&place, "image.sabi", &["--set", &set]) - value).abs() < 1e-3,
            "{layer}"
        );
    }
    // A result from the cache says nothing of its picture.
    let run = place.bake("image.sabi", "cube.glb", &["--force", "--no-cache"]).good();
    let told = "layers.exr has 3 layers, of which beauty is shown; its parameter layer chooses another: albedo, depth";
    assert!(run.stderr.contains(told), "{}", run.stderr);
    let run = place
        .bake("image.sabi", "cube.glb", &["--force", "--set", "img.layer=albido"])
        .fails(65);
    let told = "parameter 'layer' of node 'img' (source/image): layers.exr has no layer 'albido'; it has beauty, albedo, depth";
    assert!(run.stderr.contains(told), "{}", run.stderr);
    place.write("plain.bmp", bmp(51));
    let set = ["--force", "--set", "img.file=plain.bmp", "--set", "img.layer=a"];
    let run = place.bake("image.sabi", "cube.glb", &set).fails(65);
    let told = "plain.bmp has no layer 'a'; only OpenEXR files have layers, so leave the name empty";
    assert!(run.stderr.contains(told), "{}", run.stderr);
}

/// A PNG whose colors have the primaries of BT.2020 and the curve PQ (PNG specification, 11.3.2.6).
fn png_with_curve_pq() -> Vec<u8> {
    let options = sabi_image::PngOptions {
        channels: 3,
        bits: 8,
        srgb_chunk: false,
    };
    let plain = sabi_image::encode_png(1, 1, sabi_image::PngData::U8(&[200, 100, 50]), options).unwrap();
    let chunk = b"cICP\x09\x10\x00\x01";
    // Behind the signature and the header.
    let (before, after) = plain.split_at(8 + 25);
    let length = 4_u32.to_be_bytes();
    let sum = crc32(chunk).to_be_bytes();
    [before, &length, chunk, &sum, after].concat()
}

#[test]
fn what_a_picture_declares_about_its_colors_and_is_not_applied_is_told_where_they_are_shown() {
    let place = CliFolder::new();
    place.write("pq.png", png_with_curve_pq());
    let told = "pq.png declares the curve PQ (cICP), which Sabi does not apply";
    let of = |output: &str, kind: &str, more: &str| {
        graph(&format!(
            r#""img": {{ "kind": "source/image", "params": {{ "file": "pq.png"{more} }} }},
    "out": {{ "kind": "output/{kind}", "inputs": {{ "source": "img.{output}" }} }}"#
        ))
        .replace("clouds.", "img.")
    };
    for (output, kind, more, is_told) in [
        ("color", "color", "", true),
        ("color", "color", r#", "color_space": "srgb""#, false),
        ("mask", "mask", "", false),
    ] {
        place.write("image.sabi", of(output, kind, more));
        let run = place.bake("image.sabi", "cube.glb", &["--force", "--no-cache"]).good();
        assert_eq!(run.stderr.contains(told), is_told, "{output}{more}: {}", run.stderr);
    }
}
