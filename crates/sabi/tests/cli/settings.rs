//! Values set on the command line.

use crate::cli_folder::CliFolder;

#[test]
fn a_wrong_setting_is_refused_and_the_nearest_name_is_told() {
    let place = CliFolder::new();
    let cases = [
        (
            "amout=1",
            "clouds.sabi: nothing is called \"amout\" (did you mean \"amount\"?); set an exposed knob (\"amount\", \
             \"look\") or a node's parameter as node.param",
        ),
        (
            "cloud.gain=1",
            "clouds.sabi: nothing is called \"cloud.gain\" (did you mean \"clouds.gain\"?); set an exposed knob \
             (\"amount\", \"look\") or a node's parameter as node.param",
        ),
        (
            "clouds.gian=1",
            "clouds.sabi: node 'clouds' (noise/simplex) has no parameter 'gian'; did you mean 'gain'?",
        ),
        (
            "amount=high",
            "clouds.sabi: \"amount\" takes a number from 0 to 1, not a text",
        ),
        (
            "amount=0,5",
            "clouds.sabi: \"amount\" takes a number from 0 to 1, not \"0,5\"; write the decimal point, as in 0.5",
        ),
        (
            "clouds.size=0,5",
            "clouds.sabi: parameter 'size' of node 'clouds' (noise/simplex) takes a number from 0.0001 to 100, not \"0,5\"; \
             write the decimal point, as in 0.5",
        ),
        (
            "amount=2",
            "clouds.sabi: \"amount\" is 2, but goes from 0 to 1; choose a value in that range",
        ),
        (
            "clouds.octaves=4000000000",
            "clouds.sabi: parameter 'octaves' of node 'clouds' (noise/simplex) takes a whole number from 1 to 16, not 4000000000",
        ),
        (
            "clouds.size=nan",
            "clouds.sabi: parameter 'size' of node 'clouds' (noise/simplex) takes a number from 0.0001 to 100, not \"nan\"",
        ),
        (
            "look=spiky",
            "clouds.sabi: parameter 'mode' of node 'clouds' (noise/simplex) takes one of fbm, billow, ridged, not \"spiky\"",
        ),
        (
            "amount",
            "--set: 'amount' is not of the form NAME=VALUE, as in amount=0.8 or paint.color=#6b3a1e",
        ),
    ];
    for (setting, words) in cases {
        place.refuses("clouds.sabi", "cube.glb", &["--set", setting], 2, words);
    }
    place.refuses(
        "clouds.sabi",
        "cube.glb",
        &["--variant", "heavi"],
        2,
        "clouds.sabi: there is no variant \"heavi\" (did you mean \"heavy\"?); this graph has \"heavy\"",
    );
}

#[test]
fn the_last_setting_wins_over_the_variant_and_the_file() {
    let place = CliFolder::new();
    let map = |more: &[&str]| {
        place.bake("clouds.sabi", "cube.glb", more).good();
        place.read("out/cube_mask.png")
    };
    let heavy = map(&["--variant", "heavy"]);
    assert_ne!(heavy, map(&[]));
    assert_eq!(heavy, map(&["--set", "amount=0.9"]));
    assert_eq!(
        heavy,
        map(&["--variant", "heavy", "--set", "amount=0.1", "--set", "clouds.gain=0.9"])
    );
    assert_ne!(map(&[]), map(&["--seed", "5"]));
}

#[test]
fn a_number_below_its_range_is_answered_with_the_range() {
    let place = CliFolder::new();
    let cases = [
        (["--seed", "-1"], "it takes a whole number from 0 to 4294967295"),
        (["--seed", "abc"], "it takes a whole number from 0 to 4294967295"),
        (["--scale", "-1"], "it takes a number above 0"),
    ];
    for (more, words) in cases {
        let run = place.bake("clouds.sabi", "cube.glb", &more).fails(2);
        assert!(run.stderr.contains(words), "{}", run.stderr);
    }
}

#[test]
fn a_text_of_digits_alone_is_set_as_it_was_typed() {
    for (setting, file) in [
        ("out.name=042", "cube_042.png"),
        ("out.name=true", "cube_true.png"),
        ("out.name=1,2", "cube_1,2.png"),
    ] {
        let place = CliFolder::new();
        place.bake("clouds.sabi", "cube.glb", &["--set", setting]).good();
        assert!(place.path("out").join(file).is_file(), "{setting}");
    }
}
