//! `sabi render`: pictures of the model.

use crate::place::{Done, Place, software_adapter};

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

fn render(place: &Place, more: &[&str]) -> Done {
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
    let place = Place::new();
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
fn a_clear_background_has_alpha() {
    let place = Place::new();
    software_adapter();
    render(&place, &["-o", "clear.png", "--transparent"]).good();
    assert_eq!(header(&place.read("clear.png")), (48, 32, 6));
}

#[test]
fn a_turntable_is_numbered_frames_of_which_the_first_is_the_picture() {
    let place = Place::new();
    software_adapter();
    render(&place, &["-o", "still.png"]).good();
    let run = render(&place, &["-o", "turn.png", "--turntable", "3"]).good();
    assert_eq!(run.stdout, "turn_0000.png\nturn_0001.png\nturn_0002.png\n");
    assert_eq!(place.read("turn_0000.png"), place.read("still.png"));
    assert_ne!(place.read("turn_0001.png"), place.read("turn_0002.png"));
    assert!(!place.path("turn.png").exists());
}

#[test]
fn what_makes_no_sense_is_refused_before_anything_is_drawn() {
    let place = Place::new();
    place.write("broken.hdr", b"#?RADIANCE\nnothing more");
    for (more, code, told) in [
        (&["-o", "x.jpg"][..], 2, "error: x.jpg: a picture is a .png"),
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
            "error: there is no environment 'studo', and no file of that name; Sabi has studio, overcast, low_sun; did you \
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
    for more in [
        &["--camera", "above"][..],
        &["--camera", "1,2,3,4"],
        &["--samples", "0"],
        &["--turntable", "0"],
        &["--light", "40"],
        &["--exposure", "nan"],
    ] {
        let run = render(&place, &[more, &["-o", "x.png"]].concat()).fails(2);
        assert!(run.stderr.contains(more[0]), "{more:?}: {}", run.stderr);
    }
    let lights = ["--light", "1,2"].repeat(5);
    let run = render(&place, &[&lights[..], &["-o", "x.png"]].concat()).fails(2);
    assert_eq!(run.stderr, "error: --light stands 5 times; a scene has four lights\n");
    assert!(!place.path("x.png").exists());
}
