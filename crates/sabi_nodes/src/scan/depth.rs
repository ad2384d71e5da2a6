//! A limit on how deep expressions nest, so that no file can exhaust the stack of the compiler.

use super::tokens::{Token, TokenKind};
use crate::fault::{Fault, Text};

/// Most operators in one unbroken expression, and most brackets open at once.
const DEPTH_LIMIT: usize = 256;

/// The tree of `a + a + a + …` is as deep as the text is long. Counts operators since the last comma or semicolon, for
/// each open bracket; chains of `else if` nest the same way.
pub(super) fn check_depth(text: Text<'_>, tokens: &[Token]) -> Option<Fault> {
    let mut open: Vec<usize> = vec![0];
    let mut total = 0;
    for token in tokens {
        let is_inside = open.len() > 1;
        let count = open.last_mut()?;
        match token.kind {
            TokenKind::Sign('(' | '[' | '{') => open.push(0),
            // naga refuses brackets that were not opened.
            TokenKind::Sign(')' | ']' | '}') if is_inside => total -= open.pop()?,
            TokenKind::Sign(')' | ']' | '}') => {}
            TokenKind::Sign(',' | ';') => {
                total -= *count;
                *count = 0;
            }
            TokenKind::Sign(_) => {
                *count += 1;
                total += 1;
            }
            TokenKind::Word if &text.text[token.range.clone()] == "else" => {
                *count += 1;
                total += 1;
            }
            _ => {}
        }
        if total + open.len() > DEPTH_LIMIT {
            return Some(text.fault(
                token.range.clone(),
                format!("The expression is too deep here: it has more than {DEPTH_LIMIT} operators and brackets."),
                "Name parts of it with `let`, or use a loop.",
            ));
        }
    }
    None
}
