//! Splits WGSL text into the tokens that the scanner needs. naga cannot be used for this: it keeps neither the places of
//! doc comments nor plain comments.

use std::ops::Range;

/// Kind of a token.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum TokenKind {
    /// An identifier, a keyword or a number.
    Word,
    /// Any other single character.
    Sign(char),
    /// `/// …`
    Doc,
    /// `//! …`
    ModuleDoc,
    /// `// …` or `/* … */`
    Plain,
    /// `/** … */` or `/*! … */`
    BlockDoc,
}

/// A piece of the text.
#[derive(Clone, Debug)]
pub(crate) struct Token {
    pub(crate) kind: TokenKind,
    pub(crate) range: Range<usize>,
    /// True if code precedes it on the same line.
    pub(crate) after_code: bool,
}

/// Returns true for a line break in WGSL, which ends a `//` comment.
fn is_line_break(c: char) -> bool {
    matches!(c, '\u{000a}'..='\u{000d}' | '\u{0085}' | '\u{2028}' | '\u{2029}')
}

/// Splits a text into tokens, in order. This never fails: text that is not WGSL becomes signs, which naga refuses later.
pub(crate) fn tokens(text: &str) -> Vec<Token> {
    let mut tokens: Vec<Token> = Vec::new();
    let mut at = 0;
    let mut line_has_code = false;
    while let Some(c) = text[at..].chars().next() {
        let rest = &text[at..];
        if is_line_break(c) || c.is_whitespace() || matches!(c, '\u{200e}' | '\u{200f}') {
            line_has_code &= !is_line_break(c);
            at += c.len_utf8();
            continue;
        }
        let (kind, length) = if rest.starts_with("//") {
            let kind = match rest.as_bytes().get(2) {
                Some(b'/') => TokenKind::Doc,
                Some(b'!') => TokenKind::ModuleDoc,
                _ => TokenKind::Plain,
            };
            (kind, rest.find(is_line_break).unwrap_or(rest.len()))
        } else if rest.starts_with("/*") {
            let kind = match rest.as_bytes().get(2) {
                Some(b'*') if rest.as_bytes().get(3) != Some(&b'/') => TokenKind::BlockDoc,
                Some(b'!') => TokenKind::BlockDoc,
                _ => TokenKind::Plain,
            };
            (kind, block_comment_length(rest))
        } else if starts_number(rest) {
            (TokenKind::Word, number_length(rest))
        } else if c == '_' || c.is_alphanumeric() {
            let end = rest.find(|c: char| c != '_' && !c.is_alphanumeric());
            (TokenKind::Word, end.unwrap_or(rest.len()))
        } else {
            (TokenKind::Sign(c), c.len_utf8())
        };
        tokens.push(Token {
            kind,
            range: at..at + length,
            after_code: line_has_code,
        });
        line_has_code |= matches!(kind, TokenKind::Word | TokenKind::Sign(_));
        if rest[..length].contains(is_line_break) {
            line_has_code = false;
        }
        at += length;
    }
    tokens
}

fn starts_number(text: &str) -> bool {
    let digits = text.strip_prefix('.').unwrap_or(text);
    digits.starts_with(|c: char| c.is_ascii_digit())
}

/// Returns the length in bytes of the number at the start of `text`, including one point, one exponent and a suffix.
fn number_length(text: &str) -> usize {
    let bytes = text.as_bytes();
    let is_hex = matches!(bytes, [b'0', b'x' | b'X', ..]);
    let skip = |from: usize, is_part: fn(&u8) -> bool| {
        let rest = bytes.get(from..).unwrap_or(&[]);
        from + rest.iter().take_while(|byte| is_part(byte)).count()
    };
    let (is_digit, exponent): (fn(&u8) -> bool, [u8; 2]) = match is_hex {
        true => (u8::is_ascii_hexdigit, *b"pP"),
        false => (u8::is_ascii_digit, *b"eE"),
    };
    let mut at = skip(if is_hex { 2 } else { 0 }, is_digit);
    if bytes.get(at) == Some(&b'.') {
        at = skip(at + 1, is_digit);
    }
    if bytes.get(at).is_some_and(|byte| exponent.contains(byte)) {
        let signed = usize::from(matches!(bytes.get(at + 1), Some(b'+' | b'-')));
        if bytes.get(at + 1 + signed).is_some_and(u8::is_ascii_digit) {
            at = skip(at + 1 + signed, u8::is_ascii_digit);
        }
    }
    skip(at, |byte| byte.is_ascii_alphanumeric() || *byte == b'_')
}

/// Returns the length in bytes of the (nested) block comment at the start of `text`.
fn block_comment_length(text: &str) -> usize {
    let bytes = text.as_bytes();
    let mut depth = 0;
    let mut at = 0;
    while at + 1 < bytes.len() {
        match &bytes[at..at + 2] {
            b"/*" => {
                depth += 1;
                at += 2;
            }
            b"*/" => {
                depth -= 1;
                at += 2;
                if depth == 0 {
                    return at;
                }
            }
            _ => at += 1,
        }
    }
    text.len()
}
