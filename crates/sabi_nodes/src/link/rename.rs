//! Prefixes names, so that the names of several node files differ in one module.

use std::collections::BTreeSet;

/// A token of WGSL, in the detail needed for renaming.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum RenameToken<'a> {
    Word(&'a str),
    Number(&'a str),
    Mark(char),
    Space(&'a str),
}

/// Prefixes every name that the text declares at module scope. Line numbers stay the same; comments are removed.
///
/// Members of structs (declared or accessed by `.`) and attributes keep their names. A local variable with the name of a
/// declared item is renamed along with it, which has no effect on the program.
pub(super) fn with_prefix(text: &str, prefix: &str) -> String {
    let tokens = tokens(text);
    let declared = declared(&tokens);
    let mut out = String::with_capacity(text.len());
    let mut members = MemberScan::default();
    let mut previous = RenameToken::Space("");
    for (index, token) in tokens.iter().enumerate() {
        let is_member = members.is_member(&tokens, index);
        match token {
            RenameToken::Word(word) => {
                let after_mark = matches!(previous, RenameToken::Mark('.' | '@'));
                if declared.contains(word) && !after_mark && !is_member {
                    out.push_str(prefix);
                }
                out.push_str(word);
            }
            RenameToken::Number(text) | RenameToken::Space(text) => out.push_str(text),
            RenameToken::Mark(mark) => out.push(*mark),
        }
        if !matches!(token, RenameToken::Space(_)) {
            previous = *token;
        }
    }
    out
}

/// Tracks struct declarations to distinguish member names from other words.
#[derive(Default)]
struct MemberScan {
    after_struct: bool,
    inside: bool,
    depth: u32,
}

impl MemberScan {
    fn is_member(&mut self, tokens: &[RenameToken<'_>], index: usize) -> bool {
        match tokens[index] {
            RenameToken::Word("struct") => self.after_struct = true,
            RenameToken::Mark('{') if self.after_struct => {
                self.after_struct = false;
                self.inside = true;
            }
            RenameToken::Mark('}') if self.inside => self.inside = false,
            RenameToken::Mark('(' | '<') if self.inside => self.depth += 1,
            RenameToken::Mark(')' | '>') if self.inside => self.depth = self.depth.saturating_sub(1),
            RenameToken::Word(_) if self.inside && self.depth == 0 => {
                let next = tokens[index + 1..]
                    .iter()
                    .find(|token| !matches!(token, RenameToken::Space(_)));
                return next == Some(&RenameToken::Mark(':'));
            }
            _ => {}
        }
        false
    }
}

/// Returns the names that the text declares at module scope.
fn declared<'a>(tokens: &[RenameToken<'a>]) -> BTreeSet<&'a str> {
    let mut names = BTreeSet::new();
    let mut depth = 0_i32;
    let mut declares = false;
    for token in tokens {
        match token {
            RenameToken::Mark('{' | '(') => depth += 1,
            RenameToken::Mark('}' | ')') => depth -= 1,
            RenameToken::Word("fn" | "struct" | "const" | "alias" | "override") if depth == 0 => declares = true,
            RenameToken::Word(word) if declares => {
                names.insert(*word);
                declares = false;
            }
            _ => {}
        }
    }
    names
}

fn tokens(text: &str) -> Vec<RenameToken<'_>> {
    let mut tokens = Vec::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        if rest.starts_with("//") {
            rest = &rest[rest.find('\n').unwrap_or(rest.len())..];
            continue;
        }
        if rest.starts_with("/*") {
            let (comment, after) = rest.split_at(block_comment_length(rest));
            tokens.push(RenameToken::Space(" "));
            // Keep line breaks, so that line numbers stay the same as in the file.
            tokens.extend(comment.matches('\n').map(RenameToken::Space));
            rest = after;
            continue;
        }
        let length = if first.is_whitespace() {
            run_length(rest, char::is_whitespace)
        } else if first.is_alphanumeric() || first == '_' {
            run_length(rest, |c| c.is_alphanumeric() || c == '_')
        } else {
            first.len_utf8()
        };
        let piece = &rest[..length];
        tokens.push(if first.is_whitespace() {
            RenameToken::Space(piece)
        } else if first.is_ascii_digit() {
            RenameToken::Number(piece)
        } else if first.is_alphanumeric() || first == '_' {
            RenameToken::Word(piece)
        } else {
            RenameToken::Mark(first)
        });
        rest = &rest[length..];
    }
    tokens
}

fn run_length(text: &str, belongs: impl Fn(char) -> bool) -> usize {
    text.find(|c| !belongs(c)).unwrap_or(text.len())
}

/// Returns the length in bytes of the block comment at the start of the text. Block comments nest.
fn block_comment_length(text: &str) -> usize {
    let mut depth = 0;
    let mut at = 0;
    while at < text.len() {
        if text[at..].starts_with("/*") {
            depth += 1;
            at += 2;
        } else if text[at..].starts_with("*/") {
            depth -= 1;
            at += 2;
            if depth == 0 {
                return at;
            }
        } else {
            at += text[at..].chars().next().map_or(1, char::len_utf8);
        }
    }
    text.len()
}

#[cfg(test)]
mod tests {
    use super::with_prefix;

    #[test]
    fn only_names_declared_at_module_scope_are_prefixed() {
        let cases = [
            (
                "fn mask() -> f32 { return helper(1.0); } fn helper(x: f32) -> f32 { return x; }",
                "fn k__mask() -> f32 { return k__helper(1.0); } fn k__helper(x: f32) -> f32 { return x; }",
            ),
            (
                "struct Params { size: f32, mask: vec3<f32>, } fn mask(p: Params) -> f32 { return p.mask.x * p.size; }",
                "struct k__Params { size: f32, mask: vec3<f32>, } fn k__mask(p: k__Params) -> f32 { return p.mask.x * p.size; }",
            ),
            (
                "const size = 1.0; // size\nfn f() -> f32 { let a = size; return a; }",
                "const k__size = 1.0; \nfn k__f() -> f32 { let a = k__size; return a; }",
            ),
            (
                "fn f() { /* f /* g */ */ let x = 1.0f; }",
                "fn k__f() {   let x = 1.0f; }",
            ),
            (
                "struct S { @size(16) size: f32 } const size = 2;",
                "struct k__S { @size(16) size: f32 } const k__size = 2;",
            ),
            (
                "const a = 1; /* one\ntwo */\nconst b = 2;",
                "const k__a = 1;  \n\nconst k__b = 2;",
            ),
        ];
        for (text, expected) in cases {
            assert_eq!(with_prefix(text, "k__"), expected);
        }
    }
}
