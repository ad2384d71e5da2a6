//! Assignment of outputs to the materials of the model.

use crate::cli_folder::{CliFolder, graph};

/// Two triangles, one of wood and one of steel.
const PLATES: &str = "\
v 0 0 0
v 1 0 0
v 0 1 0
v 1 1 0
vt 0.1 0.1
vt 0.9 0.1
vt 0.1 0.9
vt 0.9 0.9
usemtl wood
f 1/1 2/2 3/3
usemtl steel
f 2/2 4/4 3/3
";

const BASES: &str = r##"    "blue": { "kind": "source/material", "params": { "color": "#0000ff" } },
    "clouds": { "kind": "noise/simplex" },
    "red": { "kind": "source/material", "params": { "color": "#ff0000" } }"##;

/// An output of one of the two materials.
fn output(id: &str, material: &str, materials: &str) -> String {
    format!(
        ",\n    \"{id}\": {{ \"kind\": \"output/material\", \"inputs\": {{ \"material\": \"{material}\" }}, \"params\": {{ \
         \"materials\": \"{materials}\" }} }}"
    )
}

fn place(outputs: &[String]) -> CliFolder {
    let place = CliFolder::new();
    place.write("plates.obj", PLATES);
    place.write("plates.sabi", graph(&format!("{BASES}{}", outputs.concat())));
    place
}

/// The base colors that a bake reports, by material.
fn colors(place: &CliFolder, more: &[&str]) -> (Vec<String>, String) {
    let run = place
        .bake("plates.sabi", "plates.obj", &[more, &["--json"]].concat())
        .good();
    let report: serde_json::Value = serde_json::from_str(&run.stdout).unwrap();
    let constants = report["constants"].as_array().unwrap().iter();
    let colors = constants.filter(|constant| constant["channel"] == "base_color");
    let text = |value: &serde_json::Value| value.as_str().unwrap().to_owned();
    let colors = colors.map(|constant| format!("{} {}", text(&constant["material"]), text(&constant["srgb"])));
    let warnings = run.stderr.lines().filter(|line| line.starts_with("warning: "));
    (colors.collect(), warnings.collect::<Vec<_>>().join("\n"))
}

#[test]
fn an_output_that_lists_the_material_wins_over_one_that_serves_all() {
    let place = place(&[output("all", "blue", "*"), output("named", "red", "steel")]);
    let both = (
        vec!["steel #ff0000".to_owned(), "wood #0000ff".to_owned()],
        String::new(),
    );
    assert_eq!(colors(&place, &[]), both);
    let wood = (vec!["wood #0000ff".to_owned()], String::new());
    assert_eq!(colors(&place, &["--material", "wood"]), wood);
}

#[test]
fn each_of_three_materials_gets_its_own_output_or_keeps_its_maps() {
    let three = "usemtl glass\nvt 0.95 0.95\nv 2 0 0\nf 2/2 5/5 4/4\n";
    let cases = [
        ("steel", "glass", "steel #ff0000, glass #0000ff", vec!["wood"]),
        (
            "steel, wood",
            "glass",
            "steel #ff0000, glass #0000ff, wood #ff0000",
            vec![],
        ),
        ("glass", "*", "steel #0000ff, glass #ff0000, wood #0000ff", vec![]),
        ("glass", "gla*", "glass #ff0000", vec!["wood", "steel"]),
    ];
    for (first, second, expected, kept) in cases {
        let place = place(&[output("a", "red", first), output("b", "blue", second)]);
        place.write("plates.obj", format!("{PLATES}{three}"));
        let (mut found, warnings) = colors(&place, &[]);
        let mut expected: Vec<&str> = expected.split(", ").collect();
        expected.sort_unstable();
        found.sort_unstable();
        assert_eq!(found, expected, "{first} and {second}");
        let told: Vec<&str> = warnings
            .lines()
            .filter_map(|line| line.strip_prefix("warning: the material '")?.split('\'').next())
            .collect();
        assert_eq!(told, kept, "{first} and {second}");
    }
}

#[test]
fn outputs_without_a_material_and_materials_without_an_output_are_told() {
    let place = place(&[
        output("idle", "blue", "wod"),
        output("one", "red", "steel"),
        output("two", "blue", "steel"),
    ]);
    assert_eq!(
        colors(&place, &[]),
        (
            vec!["steel #ff0000".to_owned()],
            "warning: output 'idle' serves no material: its 'materials' lists none of the model's, which are 'wood', \
             'steel'\nwarning: output 'two' serves no material: other outputs serve all that it could\nwarning: the \
             material 'wood' keeps the maps it has, since no output serves it; to bake it, list it in 'materials' of an \
             output"
                .to_owned()
        )
    );
}

#[test]
fn a_bake_that_would_write_nothing_is_refused() {
    let place = place(&[output("out", "blue", "wod")]);
    place.refuses(
        "plates.sabi",
        "plates.obj",
        &[],
        65,
        "plates.sabi: no output serves 'wood', 'steel', so there is nothing to bake; the model has 'wood', 'steel': list \
         one of them in 'materials' of an output",
    );
    let unknown = "the model has no material 'stone'; it has wood, steel";
    place.refuses("plates.sabi", "plates.obj", &["--material", "stone"], 2, unknown);
}

#[test]
fn a_preview_says_which_of_several_sets_it_shows() {
    let place = place(&[output("out", "blue", "*")]);
    crate::cli_folder::software_adapter();
    let preview = |node: &str, more: &[&str]| {
        let arguments = "preview plates.sabi --mesh plates.obj --size 64 --adapter cpu -o a.png --node";
        let arguments: Vec<&str> = arguments.split(' ').chain([node]).chain(more.iter().copied()).collect();
        place.sabi(&arguments)
    };
    assert_eq!(
        preview("clouds", &[]).good().stderr,
        "warning: this shows 'wood', the first of 2 texture sets; choose another material with --material\n"
    );
    assert_eq!(preview("clouds", &["--material", "steel"]).good().stderr, "");
    assert_eq!(
        preview("clouds", &["--material", "stone"]).fails(2).stderr,
        "error: the model has no material 'stone'; it has wood, steel\n"
    );
    // Errors of the graph and the command line are reported before errors of the model.
    std::fs::remove_file(place.path("plates.obj")).unwrap();
    assert_eq!(
        preview("cluds", &[]).fails(2).stderr,
        "error: the graph has no node 'cluds'; did you mean 'clouds'?\n"
    );
}
