use super::*;

const WORDS: [(&str, Option<&str>); 3] = [
    ("graph", Some("worn/bench")),
    ("variant", None),
    ("mesh", Some("bench")),
];

fn parts(udim: Option<u32>) -> NameParts<'static> {
    NameParts {
        material: "wood",
        map: "base_color",
        udim,
        size: [1024, 512],
    }
}

#[test]
fn names_stand_where_the_pattern_has_them() {
    let cases = [
        (NamePattern::DEFAULT, "wood_base_color", "wood_base_color.1002"),
        (
            "T_{material}_{channel}_{size}",
            "T_wood_base_color_1024x512",
            "T_wood_base_color_1024x512.1002",
        ),
        ("$graph-$map", "worn_bench-base_color", "worn_bench-base_color.1002"),
        ("$map", "base_color", "base_color.1002"),
        ("$mesh(_$variant)_$map", "bench_base_color", "bench_base_color.1002"),
        ("$mesh_$variant$map", "bench_base_color", "bench_base_color.1002"),
        ("$material(_u$udim)_$map", "wood_base_color", "wood_u1002_base_color"),
        ("$$$($material$)_$map", "$(wood)_base_color", "$(wood)_base_color.1002"),
    ];
    for (text, plain, of_tile) in cases {
        let pattern = NamePattern::parse(text, &WORDS).unwrap();
        assert_eq!(pattern.name(&parts(None)), plain, "{text}");
        assert_eq!(pattern.name(&parts(Some(1002))), of_tile, "{text}");
        for stem in [plain, of_tile] {
            assert!(pattern.may_give(stem, "base_color"), "{text}: {stem}");
            assert!(!pattern.may_give(stem, "height"), "{text}: {stem}");
            assert!(!pattern.may_give(&format!("{stem}s"), "base_color"), "{text}: {stem}");
        }
    }
    assert_eq!(
        NamePattern::parse(NamePattern::DEFAULT, &[]).unwrap(),
        NamePattern::default()
    );
    assert!(!NamePattern::default().may_give("_height", "height"));
}

#[test]
fn groups_in_each_other_are_followed_at_once() {
    // One by one, this would take as long as the letters of the name to the power of the groups.
    let text = format!("$map{}{}", "($material".repeat(12), ")".repeat(12));
    let pattern = NamePattern::parse(&text, &[]).unwrap();
    let stem = format!("height{}", "a".repeat(200));
    assert!(pattern.may_give(&stem, "height"));
    assert!(!pattern.may_give(&stem, "normal"));
}

#[test]
fn patterns_that_cannot_be_names_say_why() {
    let letters = "it has letters that a file name cannot have, or too many; use plain letters, digits, '_' and '-'";
    let known = "there is: $material, $map, $channel, $udim, $size, $graph, $variant, $mesh";
    let cases = [
        (
            "map",
            "without $map all maps would be one file; write it where the map's name is to stand".to_owned(),
        ),
        (
            "{map",
            "a brace is opened and not closed; close it after the word".to_owned(),
        ),
        (
            "$map(.$udim",
            "a group is opened and not closed; close it with )".to_owned(),
        ),
        (
            "$map)",
            "a group is closed that was not opened; write $( and $) for plain parentheses".to_owned(),
        ),
        (
            "$map(((((((((((((((((a)))))))))))))))))",
            "groups are in each other more than 16 deep".to_owned(),
        ),
        ("{mapp}", format!("nobody knows $mapp; {known}")),
        ("$chanel_x", format!("nobody knows $chanel; {known}")),
        ("../$map", letters.to_owned()),
        (".$map", letters.to_owned()),
    ];
    for (text, why) in cases {
        let told = NamePattern::parse(text, &WORDS).unwrap_err().to_string();
        assert_eq!(told, format!("maps cannot be named '{text}': {why}"));
    }
    assert!(NamePattern::parse(&format!("{}$map", "a".repeat(300)), &[]).is_err());
}
