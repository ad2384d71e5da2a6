//! Values from files: `--set-file`.

use crate::cli_folder::{CliFolder, software_adapter};

/// The exact values of the clouds of `clouds.sabi`, evaluated with these options.
fn clouds(place: &CliFolder, more: &[&str]) -> Vec<u8> {
    let fixed = [
        "preview",
        "clouds.sabi",
        "--mesh",
        "cube.glb",
        "--size",
        "64",
        "--adapter",
        "cpu",
        "--node",
        "clouds",
        "-o",
        "clouds.exr",
    ];
    place.sabi(&[&fixed, more].concat()).good();
    place.read("clouds.exr")
}

#[test]
fn the_command_line_wins_over_files_later_files_over_earlier_ones_and_values_over_the_variant() {
    software_adapter();
    let place = CliFolder::new();
    place.write("heavy.toml", "variant = \"heavy\"\n");
    place.write(
        "light.toml",
        "variant = \"heavy\"\nseed = 3\n[set]\namount = 0.2\nlook = \"ridged\"\n",
    );
    place.write("param.toml", "[set]\namount = 0.8\nclouds.gain = 0.3\n");
    place.write("seed.toml", "seed = 4\n");
    let cases: [(&[&str], &[&str]); 6] = [
        (&["--set-file", "heavy.toml"], &["--variant", "heavy"]),
        (
            &["--set-file", "light.toml"],
            &["--seed", "3", "--set", "amount=0.2", "--set", "look=ridged"],
        ),
        (
            &["--set-file", "light.toml", "--set", "amount=0.4", "--seed", "9"],
            &["--seed", "9", "--set", "amount=0.4", "--set", "look=ridged"],
        ),
        (&["--set-file", "param.toml"], &["--set", "clouds.gain=0.3"]),
        (
            &[
                "--set-file",
                "light.toml",
                "--set-file",
                "param.toml",
                "--set-file",
                "seed.toml",
            ],
            &["--seed", "4", "--set", "look=ridged", "--set", "amount=0.3"],
        ),
        (
            &[
                "--set-file",
                "seed.toml",
                "--set-file",
                "light.toml",
                "--variant",
                "heavy",
            ],
            &["--seed", "3", "--set", "amount=0.2", "--set", "look=ridged"],
        ),
    ];
    let plain = clouds(&place, &[]);
    for (with_files, without) in cases {
        let result = clouds(&place, with_files);
        assert!(result == clouds(&place, without), "{with_files:?}");
        assert!(result != plain, "{with_files:?}");
    }
}

#[test]
fn a_color_and_a_word_are_written_as_texts_and_vectors_as_lists() {
    software_adapter();
    let place = CliFolder::new();
    let look = "[set]\n\"base.color\" = \"#ff0000\"\nrust.height = 0.02\nclouds.mode = \"billow\"\nclouds.stretch = [1, 2.5, 1]\n";
    place.write("look.toml", look);
    place
        .bake("rust.sabi", "cube.glb", &["--set-file", "look.toml", "-o", "files"])
        .good();
    let set = [
        "--set",
        "base.color=#ff0000",
        "--set",
        "rust.height=0.02",
        "--set",
        "clouds.mode=billow",
        "--set",
        "clouds.stretch=1,2.5,1",
        "-o",
        "flags",
    ];
    place.bake("rust.sabi", "cube.glb", &set).good();
    let names = place.listing("files");
    assert!(names.len() > 2 && names == place.listing("flags"), "{names:?}");
    for name in names {
        assert!(
            place.read(&format!("files/{name}")) == place.read(&format!("flags/{name}")),
            "{name}"
        );
    }
}

#[test]
fn a_file_of_values_that_makes_no_sense_is_refused_with_its_place() {
    let place = CliFolder::new();
    let cases = [
        (
            "varient = \"heavy\"",
            65,
            "look.toml: there is no key 'varient'; did you mean 'variant'?",
        ),
        (
            "amount = 1",
            65,
            "look.toml: there is no key 'amount' besides variant, seed and set; values stand below [set]",
        ),
        ("[set]\namount = = 1", 65, "look.toml:2:10: extra `=`, expected nothing"),
        ("[set]\namount = 1\namount = 2", 65, "look.toml:3:1: duplicate key"),
        (
            "[set]\namout = 1",
            2,
            "clouds.sabi: nothing is called \"amout\" (did you mean \"amount\"?); set an exposed knob (\"amount\", \"look\") \
             or a node's parameter as node.param",
        ),
        (
            "[set]\namount = \"high\"",
            2,
            "clouds.sabi: \"amount\" takes a number from 0 to 1, not a text",
        ),
        (
            "[set]\nclouds.octaves = [1, 2]",
            2,
            "clouds.sabi: parameter 'octaves' of node 'clouds' (noise/simplex) takes a whole number from 1 to 16, not [1, 2]",
        ),
        (
            "variant = \"heavi\"",
            2,
            "clouds.sabi: there is no variant \"heavi\" (did you mean \"heavy\"?); this graph has \"heavy\"",
        ),
    ];
    for (text, code, words) in cases {
        place.write("look.toml", text);
        place.refuses("clouds.sabi", "cube.glb", &["--set-file", "look.toml"], code, words);
    }
    let missing = "none.toml: there is no such file; check the path";
    place.refuses("clouds.sabi", "cube.glb", &["--set-file", "none.toml"], 66, missing);
    place.write("look.toml", [0x61, 0xff]);
    let binary = "look.toml: the file is not text: byte 1 is not UTF-8; files of values are TOML";
    place.refuses("clouds.sabi", "cube.glb", &["--set-file", "look.toml"], 65, binary);
}

#[test]
fn a_report_never_replaces_a_file_of_values() {
    let place = CliFolder::new();
    place.write("look.toml", "seed = 1\n");
    let more = ["--set-file", "look.toml", "--report", "look.toml"];
    let words = "cannot write the report look.toml: this very bake reads it; name another file";
    place.refuses("clouds.sabi", "cube.glb", &more, 73, words);
    assert_eq!(place.read("look.toml"), b"seed = 1\n");
}
