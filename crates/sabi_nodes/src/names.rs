//! Names of ports and parameters.

/// Words whose spelling in labels differs from names.
const SPELLINGS: [(&str, &str); 7] = [
    ("uv", "UV"),
    ("srgb", "sRGB"),
    ("rgb", "RGB"),
    ("hsv", "HSV"),
    ("id", "ID"),
    ("ao", "AO"),
    ("fbm", "FBM"),
];

/// Returns the label of a name: `tile_size` becomes `Tile size`, and `uv_set` becomes `UV set`.
pub fn label_of(name: &str) -> String {
    let spelling = |word: &str| {
        SPELLINGS
            .iter()
            .find(|(known, _)| *known == word)
            .map(|(_, spelled)| *spelled)
    };
    let words = name.split(['_', ' ']).enumerate();
    let words: Vec<String> = words
        .map(|(at, word)| match spelling(word) {
            Some(spelled) => spelled.to_owned(),
            None if at == 0 => capitalized(word),
            None => word.to_owned(),
        })
        .collect();
    words.join(" ")
}

fn capitalized(word: &str) -> String {
    let mut letters = word.chars();
    letters
        .next()
        .map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// Returns true if a text can be the name of a port, a parameter or a kind: `[a-z][a-z0-9_]*`.
pub(crate) fn is_plain_name(name: &str) -> bool {
    name.starts_with(|c: char| c.is_ascii_lowercase())
        && name
            .chars()
            .all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_')
}
