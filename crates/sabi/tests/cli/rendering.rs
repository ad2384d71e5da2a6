//! `sabi render`: pictures of the model.

use sabi_image::{Pixels, decode};

use crate::cli_folder::{CliFolder, RunOutput, graph, software_adapter};

const SMALL: [&str; 12] = [
    "--mesh",
    "cube.glb",
    "--adapter",
    "cpu",
    "--texels",
    "32",
    "--size",
    "48x32",
    "--samples",
    "2",
    "--rotate",
    "30",
];

fn render(place: &CliFolder, more: &[&str]) -> RunOutput {
    let arguments = [&["render", "rust.sabi"], &SMALL[..], more].concat();
    place.sabi(&arguments)
}

/// Width, height and color type of a PNG.
fn header(png: &[u8]) -> (u32, u32, u8) {
    let word = |at: usize| u32::from_be_bytes([png[at], png[at + 1], png[at + 2], png[at + 3]]);
    (word(16), word(20), png[25])
}

#[test]
fn a_lit_picture_is_written_and_comes_out_the_same_again() {
    let place = CliFolder::new();
    software_adapter();
    let run = render(&place, &["-o", "one.png"]).good();
    assert_eq!((run.stdout.as_str(), run.stderr.as_str()), ("one.png\n", ""));
    render(&place, &["-o", "two.png"]).good();
    let picture = place.read("one.png");
    assert_eq!(header(&picture), (48, 32, 2));
    assert_eq!(picture, place.read("two.png"));
    for more in [
        &["--environment", "low_sun"][..],
        &["--camera", "back"],
        &["--camera", "-40,-10"],
        &["--light", "-40,30,2"],
        &["--view", "roughness"],
        &["--view", "node:clouds"],
        &["--transform", "standard"],
        &["--exposure", "1"],
        &["--light", "40,30"],
        &["--lines", "wires"],
        &["--orthographic"],
        &["--background", "environment"],
    ] {
        render(&place, &[more, &["-o", "other.png"]].concat()).good();
        assert_ne!(picture, place.read("other.png"), "{more:?} changes nothing");
    }
}

#[test]
fn highlights_glow_as_much_as_bloom_says() {
    let place = CliFolder::new();
    software_adapter();
    let bright = |name: &str, more: &[&str]| {
        render(&place, &[&["--exposure", "4", "-o", name], more].concat()).good();
        place.read(name)
    };
    let usual = bright("usual.png", &[]);
    assert_ne!(usual, bright("none.png", &["--bloom", "0"]));
    assert_eq!(usual, bright("same.png", &["--bloom", "0.1"]));
    let wrong = render(&place, &["-o", "wrong.png", "--bloom", "2"]);
    assert_eq!(wrong.code, Some(2), "{}", wrong.stderr);
    assert!(
        wrong.stderr.contains("it takes a share from 0 to 1"),
        "{}",
        wrong.stderr
    );
}

#[test]
fn maps_are_as_large_as_the_picture_needs_and_smaller_ones_are_told() {
    let place = CliFolder::new();
    software_adapter();
    let fitting = |name: &str, more: &[&str]| {
        let own = [
            "render",
            "rust.sabi",
            "--mesh",
            "cube.glb",
            "--adapter",
            "cpu",
            "--samples",
            "1",
        ];
        place
            .sabi(&[&own[..], &["--size", "480x320", "-o", name], more].concat())
            .good()
    };
    assert_eq!(fitting("fitting.png", &[]).stderr, "");
    fitting("512.png", &["--texels", "512"]);
    fitting("256.png", &["--texels", "256"]);
    assert_eq!(place.read("fitting.png"), place.read("512.png"));
    assert_ne!(place.read("fitting.png"), place.read("256.png"));
    let soft = fitting("32.png", &["--texels", "32"]).stderr;
    assert!(soft.contains("the picture is soft"), "{soft}");
    assert!(
        soft.contains("and maps of 512 × 512 would be sharp; choose a larger size with --texels"),
        "{soft}"
    );
}

#[test]
fn a_model_of_flat_faces_is_smoothed_when_asked() {
    let place = CliFolder::new();
    software_adapter();
    let arguments = |name: &'static str| ["render", "rust.sabi", "--mesh", "sphere.glb", "-o", name];
    let sizes = [
        "--adapter",
        "cpu",
        "--texels",
        "32",
        "--size",
        "48x32",
        "--samples",
        "1",
    ];
    let drawn = |name: &'static str, more: &[&str]| {
        place.sabi(&[&arguments(name)[..], &sizes, more].concat()).good();
        place.read(name)
    };
    let flat = drawn("flat.png", &["--smooth", "0"]);
    let smooth = drawn("smooth.png", &["--smooth", "60"]);
    assert_ne!(flat, smooth);
    assert_eq!(smooth, drawn("again.png", &["--smooth", "60"]));
    let wrong = render(&place, &["-o", "wrong.png", "--smooth", "181"]);
    assert_eq!(wrong.code, Some(2), "{}", wrong.stderr);
    assert!(
        wrong
            .stderr
            .contains("it takes an angle in degrees, from 0 (all flat) to 180 (all smooth)"),
        "{}",
        wrong.stderr
    );
}

#[test]
fn a_clear_background_has_alpha() {
    let place = CliFolder::new();
    software_adapter();
    render(&place, &["-o", "clear.png", "--transparent"]).good();
    assert_eq!(header(&place.read("clear.png")), (48, 32, 6));
}

#[test]
fn a_turntable_is_numbered_frames_of_which_the_first_is_the_picture() {
    let place = CliFolder::new();
    software_adapter();
    render(&place, &["-o", "still.png"]).good();
    let run = render(&place, &["-o", "turn.png", "--turntable", "3"]).good();
    assert_eq!(run.stdout, "turn_0000.png\nturn_0001.png\nturn_0002.png\n");
    assert_eq!(place.read("turn_0000.png"), place.read("still.png"));
    assert_ne!(place.read("turn_0001.png"), place.read("turn_0002.png"));
    assert!(!place.path("turn.png").exists());
    // The same light from the same side, whichever of the two goes around.
    render(
        &place,
        &[
            "-o",
            "light.png",
            "--turntable",
            "3",
            "--turn",
            "light",
            "--light",
            "20,30",
        ],
    )
    .good();
    let turned = SMALL.map(|argument| if argument == "30" { "150" } else { argument });
    let side = ["render", "rust.sabi", "-o", "side.png", "--light", "140,30"];
    place.sabi(&[&side[..], &turned].concat()).good();
    assert_eq!(place.read("light_0001.png"), place.read("side.png"));
}

/// Bumps as high as a quarter of the model.
const SWOLLEN: &str = r#"    "base": { "kind": "source/material" },
    "clouds": { "kind": "noise/simplex", "params": { "size": 0.5, "octaves": 1 } },
    "coat": { "kind": "effect/layer", "inputs": { "base": "base", "mask": "clouds" }, "params": { "height": 0.25 } },
    "out": { "kind": "output/material", "inputs": { "material": "coat" } }"#;

#[test]
fn a_displaced_model_has_another_outline_and_keeps_its_lines() {
    let place = CliFolder::new();
    software_adapter();
    place.write("swollen.sabi", graph(SWOLLEN));
    let alphas = |name: &str, more: &[&str]| -> Vec<u8> {
        let own = ["render", "swollen.sabi", "--mesh", "sphere.glb", "--adapter", "cpu"];
        let sizes = [
            "--texels",
            "64",
            "--size",
            "96x96",
            "--samples",
            "1",
            "--transparent",
            "-o",
            name,
        ];
        place.sabi(&[&own[..], &sizes, more].concat()).good();
        let picture = decode(name, &place.read(name)).unwrap();
        let Pixels::U8(codes) = &picture.pixels else {
            panic!("{name} has 8 bits")
        };
        codes.chunks(picture.channels as usize).map(|pixel| pixel[3]).collect()
    };
    let flat = alphas("flat.png", &[]);
    let relief = alphas("relief.png", &["--relief"]);
    let displaced = alphas("displaced.png", &["--displace=50000"]);
    let differing = |a: &[u8], b: &[u8]| a.iter().zip(b).filter(|(a, b)| a != b).count();
    assert!(differing(&flat, &relief) < 30, "relief has the model's own outline");
    assert!(differing(&flat, &displaced) > 300, "{}", differing(&flat, &displaced));
    let both = alphas("both.png", &["--displace=50000", "--relief"]);
    assert_eq!(differing(&both, &displaced), 0);
    assert_eq!(
        place.read("both.png"),
        place.read("displaced.png"),
        "displaced, heights are not followed too"
    );
    alphas("lines.png", &["--displace=50000", "--lines", "wires"]);
    assert_ne!(place.read("lines.png"), place.read("displaced.png"));
}

#[test]
fn a_model_that_nothing_raises_is_drawn_as_it_is_and_the_artist_told_why() {
    let place = CliFolder::new();
    software_adapter();
    let run = render(&place, &["-o", "mask.png", "--view", "node:clouds", "--displace"]).good();
    assert_eq!(
        run.stderr,
        "warning: displacing the model has no effect: the shown result has no height; show the material of a graph \
         whose layers have one\n"
    );
}

#[test]
fn the_light_of_a_picture_is_linear_and_twice_as_much_a_stop_brighter() {
    let place = CliFolder::new();
    software_adapter();
    let light = |name: &str, more: &[&str]| -> Vec<f32> {
        render(&place, &[&["-o", name, "--background", "plain"], more].concat()).good();
        let picture = decode(name, &place.read(name)).unwrap();
        assert_eq!((picture.width, picture.height, picture.channels), (48, 32, 4));
        let Pixels::F32(numbers) = picture.pixels else {
            panic!("{name} holds floats")
        };
        numbers
    };
    let once = light("once.exr", &[]);
    let twice = light("twice.exr", &["--exposure", "1", "--transform", "standard"]);
    let corner: [f32; 4] = once[..4].try_into().unwrap();
    assert_eq!(corner, [0.0; 4], "a plain background is no light");
    assert!(once.chunks(4).any(|pixel| pixel[3] == 1.0));
    for (a, b) in once.chunks(4).zip(twice.chunks(4)) {
        assert_eq!([2.0 * a[0], 2.0 * a[1], 2.0 * a[2], a[3]], *b);
    }
}

#[test]
fn what_makes_no_sense_is_refused_before_anything_is_drawn() {
    let place = CliFolder::new();
    place.write("broken.hdr", b"#?RADIANCE\nnothing more");
    for (more, code, told) in [
        (
            &["-o", "x.jpg"][..],
            2,
            "error: x.jpg: a picture is a .png, or an .exr of its light",
        ),
        (
            &["-o", "x.exr", "--view", "roughness"],
            2,
            "error: x.exr: an .exr holds light, and the view 'roughness' shows none; write a .png, or show the \
             material",
        ),
        (
            &["-o", "x.exr", "--view", "node:rust"],
            2,
            "error: x.exr: an .exr holds light, and the view 'node:rust' shows none; write a .png, or show the \
             material",
        ),
        (
            &["-o", "x.png", "--view", "rust"],
            2,
            "error: there is no view 'rust'; there are material, base_color,",
        ),
        (
            &["-o", "x.png", "--view", "node:rut"],
            2,
            "error: the graph has no node 'rut'; did you mean 'rust'?",
        ),
        (
            &["-o", "x.png", "--environment", "studo"],
            2,
            "error: there is no environment 'studo', and no file of that name; Sabi has studio, overcast, low_sun, interior, softboxes; did \
             you \
             mean studio?",
        ),
        (
            &["-o", "x.png", "--environment", "none.hdr"],
            66,
            "error: there is no environment none.hdr; check the path",
        ),
        (&["-o", "x.png", "--environment", "broken.hdr"], 65, "error: broken.hdr"),
        (&["-o", "x.png", "--environment", "cube.glb"], 65, "error: cube.glb"),
    ] {
        let run = render(&place, more).fails(code);
        assert!(run.stderr.starts_with(told), "{more:?}: {}", run.stderr);
    }
    assert!(!place.path("x.png").exists() && !place.path("x.exr").exists());
}

#[test]
fn an_option_that_makes_no_sense_is_named() {
    let place = CliFolder::new();
    for more in [
        &["--camera", "above"][..],
        &["--camera", "1,2,3,4"],
        &["--samples", "0"],
        &["--turntable", "0"],
        &["--light", "40"],
        &["--exposure", "nan"],
        &["--exposure", "128"],
        &["--displace=0"],
    ] {
        let run = render(&place, &[more, &["-o", "x.png"]].concat()).fails(2);
        let option = more[0].split('=').next().unwrap();
        assert!(run.stderr.contains(option), "{more:?}: {}", run.stderr);
    }
    let lights = ["--light", "1,2"].repeat(5);
    let run = render(&place, &[&lights[..], &["-o", "x.png"]].concat()).fails(2);
    assert_eq!(run.stderr, "error: --light stands 5 times; a scene has four lights\n");
    assert!(!place.path("x.png").exists());
}
