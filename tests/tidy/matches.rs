//! Matches over enums of which every value is to be named.

use super::modules::tokens_of;

/// Names of the enums for which a match of this text has both arms that name their values and an arm `_`. A name stands for
/// all enums whose name ends in it.
pub(crate) fn catch_alls(text: &str, enums: &[&str]) -> Vec<String> {
    let tokens = tokens_of(text);
    let matches = tokens.iter().enumerate().filter(|(_, token)| *token == "match");
    let found = matches.filter_map(|(at, _)| catch_all(&tokens[at..], enums));
    found.collect()
}

/// The enum of a match that begins with these tokens, if one of its arms is `_`.
fn catch_all(tokens: &[String], enums: &[&str]) -> Option<String> {
    let mut depth = 0_usize;
    let mut is_pattern = false;
    let mut named = None;
    let mut has_catch_all = false;
    for (at, token) in tokens.iter().enumerate().skip(1) {
        match token.as_str() {
            "{" | "(" | "[" => {
                depth += 1;
                is_pattern |= depth == 1 && token == "{";
            }
            "}" | ")" | "]" => {
                depth = depth.saturating_sub(1);
                if depth == 0 && token == "}" {
                    break;
                }
                // The body of an arm ended.
                is_pattern |= depth == 1 && token == "}";
            }
            "," if depth == 1 => is_pattern = true,
            "=>" if depth == 1 => {
                has_catch_all |= tokens[at - 1] == "_" && matches!(tokens[at - 2].as_str(), "," | "{" | "}");
                is_pattern = false;
            }
            "::" if is_pattern && depth == 1 => {
                let name = &tokens[at - 1];
                if enums.iter().any(|ending| name.ends_with(ending)) {
                    named = Some(name.clone());
                }
            }
            _ => {}
        }
    }
    named.filter(|_| has_catch_all)
}

#[test]
fn a_match_that_ends_in_a_catch_all_is_found() {
    let text = "fn f() { match command { Command::A => { g(Other::B) } Command::C(x) => h(), _ => {} } }";
    assert_eq!(catch_alls(text, &["Command"]), ["Command"]);
    let text = "fn f() { match key { Key::A => do_it(Command::B), _ => match command { Command::C => (), Command::D => () } } }";
    assert!(catch_alls(text, &["Command"]).is_empty());
}
