//! String literals of Rust sources, and flags of a command line in them.

use proc_macro2::{TokenStream, TokenTree};

/// String literals of a source, quotes and all, with the lines that they begin on. Comments are none.
pub(crate) fn literals_of(source: &str) -> Vec<(usize, String)> {
    let tokens: TokenStream = source.parse().unwrap_or_else(|error| panic!("{error}\n{source}"));
    let mut found = Vec::new();
    collect(tokens, &mut found);
    found
}

fn collect(tokens: TokenStream, found: &mut Vec<(usize, String)>) {
    let mut tokens = tokens.into_iter().peekable();
    while let Some(token) = tokens.next() {
        match token {
            TokenTree::Group(group) => collect(group.stream(), found),
            TokenTree::Literal(literal) => {
                let text = literal.to_string();
                if text.ends_with(['"', '#']) {
                    found.push((literal.span().start().line, text));
                }
            }
            TokenTree::Punct(sign) if sign.as_char() == '#' => {
                tokens.next_if(|next| matches!(next, TokenTree::Punct(sign) if sign.as_char() == '!'));
                // A doc comment reads as `#[doc = "…"]`.
                tokens.next_if(is_doc_comment);
            }
            TokenTree::Punct(_) | TokenTree::Ident(_) => {}
        }
    }
}

fn is_doc_comment(token: &TokenTree) -> bool {
    let TokenTree::Group(group) = token else {
        return false;
    };
    let first = group.stream().into_iter().next();
    matches!(first, Some(TokenTree::Ident(name)) if name == "doc")
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
    let source = "//! \"a comment\"\nfn said<'a>(c: char) -> &'a str {\n    let _ = (c == '\"', b\"bytes\");\n    r#\"raw \"x\"\"#; \"one \\\" two\"\n}\n";
    let expected = [(3, "b\"bytes\""), (4, "r#\"raw \"x\"\"#"), (4, "\"one \\\" two\"")];
    assert_eq!(
        literals_of(source),
        expected.map(|(line, text)| (line, text.to_owned()))
    );
}

#[test]
fn a_flag_is_known_by_its_dashes() {
    assert_eq!(flag_in("\"raise it with --budget, or not\""), Some("--budget"));
    assert_eq!(flag_in("\"choose another folder with -o\""), Some("-o"));
    assert_eq!(flag_in("\"-o\""), None);
    assert_eq!(flag_in("\"a -- b --- c -1 --1\""), None);
}
