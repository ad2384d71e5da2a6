//! String literals of Rust sources, and flags of a command line in them.

use super::functions::skipped;

/// String literals of a source, quotes and all, with the lines that they begin on.
pub(crate) fn literals_of(source: &str) -> Vec<(usize, &str)> {
    let mut found = Vec::new();
    let (mut at, mut before) = (0, None);
    while let Some(first) = source[at..].chars().next() {
        let rest = &source[at..];
        let length = skipped(rest, before).min(rest.len());
        if length > 0 && (first == '"' || first == 'r') {
            found.push((source[..at].matches('\n').count() + 1, &rest[..length]));
        }
        before = Some(first);
        at += length.max(first.len_utf8());
    }
    found
}

/// Flag of a command line that a string literal names, such as `--size` or `-o`.
pub(crate) fn flag_in(literal: &str) -> Option<&str> {
    let is_long = |word: &str| {
        word.strip_prefix("--")
            .is_some_and(|name| name.starts_with(|c: char| c.is_ascii_lowercase()))
    };
    let mut words = literal.split(|c: char| c.is_whitespace() || "'\"`(),;:.!?=".contains(c));
    // A literal that is nothing but `"-o"` is an option of a file format, and no advice.
    words.find(|word| is_long(word) || *word == "-o" && literal != "\"-o\"")
}

#[test]
fn literals_are_told_from_comments_and_characters() {
    let source = "// \"a comment\"\nfn said<'a>(c: char) -> &'a str {\n    let _ = (c == '\"', b\"bytes\");\n    r#\"raw \"x\"\"#; \"one \\\" two\"\n}\n";
    let expected = [(3, "\"bytes\""), (4, "r#\"raw \"x\"\"#"), (4, "\"one \\\" two\"")];
    assert_eq!(literals_of(source), expected);
}

#[test]
fn a_flag_is_known_by_its_dashes() {
    assert_eq!(flag_in("\"raise it with --budget, or not\""), Some("--budget"));
    assert_eq!(flag_in("\"choose another folder with -o\""), Some("-o"));
    assert_eq!(flag_in("\"-o\""), None);
    assert_eq!(flag_in("\"a -- b --- c -1 --1\""), None);
}
