//! Names of folders, by patterns like those of maps.

use super::{NameParts, parse, push};
use crate::names::file_stem;

/// Returns the path of a folder for a pattern such as `export/$mesh/$graph(_$variant)`: `/` separates folders, and words and groups
/// are those of [`NamePattern`](super::NamePattern). A folder whose name is empty is left out.
///
/// # Errors
/// A clause that says what is wrong: an unknown word, an open group, or a part that no folder may be called.
pub fn folder_name(pattern: &str, words: &[(&str, Option<&str>)]) -> Result<String, String> {
    // All files of a set are in one folder, so these values cannot differ between files.
    let parts = NameParts {
        material: "",
        map: "",
        udim: None,
        size: [0; 2],
    };
    let mut path = String::new();
    for segment in parse::segments(pattern, &[], words)? {
        // Outside of groups, a token without a value is empty.
        push(&mut path, &segment, &parts, None).unwrap_or_default();
    }
    let root = if path.starts_with('/') { "/" } else { "" };
    let folders: Vec<&str> = path.split('/').filter(|part| !part.is_empty()).collect();
    for (at, part) in folders.iter().enumerate() {
        let is_drive = at == 0 && part.len() == 2 && part.ends_with(':');
        let is_step = matches!(*part, "." | "..");
        if !is_drive && !is_step && file_stem(part) != *part {
            let why = "has letters that a folder cannot have, or too many; use plain letters, digits, '_' and '-', and '/' \
                       between folders";
            return Err(format!("'{part}' {why}"));
        }
    }
    match folders.is_empty() {
        true => Err("nothing is left of it; write a folder".to_owned()),
        false => Ok(format!("{root}{}", folders.join("/"))),
    }
}

#[cfg(test)]
mod tests {
    use super::folder_name;

    const WORDS: [(&str, Option<&str>); 4] = [
        ("mesh", Some("crate")),
        ("graph", Some("rust")),
        ("variant", None),
        ("seed", Some("7")),
    ];

    #[test]
    fn words_of_a_folder_stand_where_the_pattern_has_them() {
        let cases = [
            ("export/$mesh/$graph(_$variant)", "export/crate/rust"),
            ("export/$mesh/$variant/$graph(_$seed)", "export/crate/rust_7"),
            ("../{mesh}s//x/", "../crates/x"),
            ("/data/$mesh", "/data/crate"),
            ("D:/data/$mesh", "D:/data/crate"),
        ];
        for (pattern, path) in cases {
            assert_eq!(folder_name(pattern, &WORDS).as_deref(), Ok(path), "{pattern}");
        }
    }

    #[test]
    fn patterns_that_cannot_be_folders_say_why() {
        let letters = "has letters that a folder cannot have, or too many; use plain letters, digits, '_' and '-', and '/' between \
                       folders";
        let cases = [
            (
                "$map",
                "nobody knows $map; there is: $mesh, $graph, $variant, $seed".to_owned(),
            ),
            (
                "a($mesh",
                "a group is opened and not closed; close it with )".to_owned(),
            ),
            ("out\\$mesh", format!("'out\\crate' {letters}")),
            ("a/b*", format!("'b*' {letters}")),
            ("$variant/", "nothing is left of it; write a folder".to_owned()),
        ];
        for (pattern, why) in cases {
            assert_eq!(folder_name(pattern, &WORDS), Err(why), "{pattern}");
        }
    }
}
