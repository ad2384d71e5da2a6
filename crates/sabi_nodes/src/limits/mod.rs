//! Limits that the text of a module must meet before it is given to the compiler: how deeply it nests, how many elements
//! its arrays have, and how large it becomes with all constants expanded.
//!
//! naga follows brackets, operators and names by recursion, and copies a constant to each place that refers to it. naga
//! limits none of this, so a small file could exhaust the stack or the memory while it is only read.

mod array_sizes;
mod expanded_declarations;
mod outline;
#[cfg(test)]
mod tests;

use naga::Span;

use crate::fault::Fault;
use crate::link::LinkedModule;
use crate::scan::tokens::{Token, TokenKind, tokens};
use array_sizes::{ArraySizes, SizeFault};
use expanded_declarations::ExpandedDeclarations;
use outline::Outline;

/// Maximum nesting of blocks, brackets and operators in one declaration.
pub(crate) const DEPTH_LIMIT: usize = 256;
/// Maximum nesting if the nesting of the functions, constants and types that a declaration refers to is added.
const CHAIN_LIMIT: usize = 512;
/// Maximum number of words and signs of a module, where a reference to a constant counts as the whole text of the constant,
/// and an array counts as its elements.
const EXPANDED_LIMIT: u64 = 1 << 20;

/// Returns the first fault of a module that is too deep or too large for the compiler.
pub(crate) fn check(linked: &LinkedModule) -> Option<Fault> {
    let text = linked.wgsl();
    let code: Vec<Token> = tokens(text)
        .into_iter()
        .filter(|token| matches!(token.kind, TokenKind::Word | TokenKind::Sign(_)))
        .collect();
    let outline = match Outline::read(text, &code) {
        Ok(outline) => outline,
        Err(too_deep) => {
            return Some(linked.fault(
                Span::from(too_deep),
                format!(
                    "The code is too deep here: more than {DEPTH_LIMIT} blocks, brackets and operators are inside each other."
                ),
                "Name parts of it with `let`, or move them into functions.",
            ));
        }
    };
    let sizes = match ArraySizes::read(text, &code, &outline) {
        Ok(sizes) => sizes,
        Err(fault) => return Some(size_fault(linked, fault)),
    };
    let expansion = ExpandedDeclarations::of(&outline, &sizes);
    expansion_fault(linked, &outline, &expansion)
}

fn size_fault(linked: &LinkedModule, fault: SizeFault) -> Fault {
    let most = array_sizes::ELEMENTS_LIMIT;
    match fault {
        SizeFault::Unknown(range) => linked.fault(
            Span::from(range),
            "The size of this array is not known.",
            "Write a number, or sums and products of numbers and of a `const` that is a whole number.",
        ),
        SizeFault::TooLarge(range, count) => linked.fault(
            Span::from(range),
            format!("This array has {count} elements; {most} are allowed."),
            "Compute less at a time, or move tables into an image; every texel has a copy of it.",
        ),
    }
}

fn expansion_fault(linked: &LinkedModule, outline: &Outline<'_>, expansion: &ExpandedDeclarations) -> Option<Fault> {
    if let Some((declaration, depth)) = expansion.first_deeper_than(CHAIN_LIMIT) {
        let declaration = &outline.declarations[declaration];
        return Some(linked.fault(
            Span::from(declaration.name_range.clone()),
            format!(
                "`{}` leads too deep: its code and that of what it names, and so on, nest {depth} deep; {CHAIN_LIMIT} are allowed.",
                declaration.name
            ),
            "Let fewer functions, constants or types name each other in a chain.",
        ));
    }
    if expansion.total > EXPANDED_LIMIT {
        let declaration = &outline.declarations[expansion.largest];
        return Some(linked.fault(
            Span::from(declaration.name_range.clone()),
            format!(
                "The file becomes too long: with all constants and arrays written out it has {} words and signs; \
                 {EXPANDED_LIMIT} are allowed.",
                expansion.total
            ),
            format!(
                "`{}` takes most of them. Name large constants less often, or make them smaller.",
                declaration.name
            ),
        ));
    }
    None
}
