//! The number of elements of each array in a text, read from the text alone. It is limited because naga expands an
//! array to all its elements when it evaluates a constant expression with it, and has no limit of its own.

use std::collections::BTreeMap;
use std::ops::Range;

use super::outline::Outline;
use crate::arithmetic::{Expression, Operator, Syntax};
use crate::scan::tokens::{Token, TokenKind};

/// Maximum number of elements of an array: 16 KiB of the smallest values.
pub(super) const ELEMENTS_LIMIT: u64 = 4096;

/// Maximum intermediate value when a size is computed, far below the numbers at which arithmetic wraps around.
const VALUE_LIMIT: f64 = (1_u64 << 31) as f64;
/// Maximum number of words and signs of a size, or of a constant in it.
const TERMS_LIMIT: usize = 256;
/// Maximum length of a chain of constants that refer to each other.
const CHAIN_LIMIT: u32 = 32;

/// Syntax of sizes: numbers and names.
const SYNTAX: Syntax = Syntax {
    has_units: false,
    is_in_name: |letter| letter.is_alphanumeric() || letter == '_',
};

/// Fault in the size of an array, with its byte range in the text.
pub(super) enum SizeFault {
    Unknown(Range<usize>),
    TooLarge(Range<usize>, u64),
}

/// Sizes of arrays, by the declaration that contains them.
pub(super) struct ArraySizes {
    of_declaration: BTreeMap<usize, u64>,
}

impl ArraySizes {
    /// Reads the sizes of all arrays in an outline.
    pub(super) fn read(text: &str, tokens: &[Token], outline: &Outline<'_>) -> Result<ArraySizes, SizeFault> {
        let mut reader = ConstantEvaluator::new(text, tokens, outline);
        let mut of_declaration: BTreeMap<usize, u64> = BTreeMap::new();
        for array in &outline.arrays {
            let mut size = array.tokens.clone();
            if tokens[size.clone()].last().map(|token| token.kind) == Some(TokenKind::Sign(',')) {
                size.end -= 1;
            }
            let [Some(first), Some(last)] = [tokens[size.clone()].first(), tokens[size.clone()].last()] else {
                continue;
            };
            let bytes = first.range.start..last.range.end;
            let Some(count) = reader.value(size, CHAIN_LIMIT) else {
                return Err(SizeFault::Unknown(bytes));
            };
            let count = count as u64;
            if count > ELEMENTS_LIMIT {
                return Err(SizeFault::TooLarge(bytes, count));
            }
            *of_declaration.entry(array.declaration).or_default() += count;
        }
        Ok(ArraySizes { of_declaration })
    }

    /// Returns the total number of elements of the arrays in a declaration.
    pub(super) fn elements(&self, declaration: usize) -> u64 {
        self.of_declaration.get(&declaration).copied().unwrap_or(0)
    }
}

/// Evaluates constant expressions of whole numbers.
struct ConstantEvaluator<'t, 'a> {
    text: &'t str,
    tokens: &'a [Token],
    /// Values of constants by name; `None` if several have the same name.
    constants: BTreeMap<&'t str, Option<Range<usize>>>,
    known: BTreeMap<String, Option<f64>>,
}

impl<'t, 'a> ConstantEvaluator<'t, 'a> {
    fn new(text: &'t str, tokens: &'a [Token], outline: &Outline<'t>) -> ConstantEvaluator<'t, 'a> {
        let mut constants: BTreeMap<&'t str, Option<Range<usize>>> = BTreeMap::new();
        for declaration in &outline.declarations {
            if let Some(value) = &declaration.value {
                let value = Some(value.clone());
                constants
                    .entry(declaration.name)
                    .and_modify(|known| *known = None)
                    .or_insert(value);
            }
        }
        ConstantEvaluator {
            text,
            tokens,
            constants,
            known: BTreeMap::new(),
        }
    }

    /// Returns the value of an expression; `None` if it is unknown or if an intermediate value exceeds the limit.
    fn value(&mut self, tokens: Range<usize>, chain: u32) -> Option<f64> {
        let tokens = self.tokens.get(tokens).filter(|tokens| tokens.len() <= TERMS_LIMIT)?;
        let words = tokens.iter().map(|token| {
            let word = self.text.get(token.range.clone())?;
            let is_number = word.starts_with(|letter: char| letter.is_ascii_digit());
            if is_number {
                whole_number(word).map(|number| number.to_string())
            } else {
                Some(word.to_owned())
            }
        });
        let words: Vec<String> = words.collect::<Option<_>>()?;
        let expression = Expression::read(&words.join(" "), 0, SYNTAX).ok()?;
        self.evaluate(&expression, chain)
    }

    fn evaluate(&mut self, expression: &Expression, chain: u32) -> Option<f64> {
        let value = match expression {
            Expression::Number(number) => *number,
            Expression::Name(name) => self.constant(&name.text, chain)?,
            Expression::Call(name, arguments) => match (name.text.as_str(), arguments.as_slice()) {
                ("u32" | "i32", [argument]) => self.evaluate(argument, chain)?,
                _ => return None,
            },
            Expression::Chain(first, rest) => {
                let mut value = self.evaluate(first, chain)?;
                for (operator, other) in rest {
                    value = within(computed(value, *operator, self.evaluate(other, chain)?))?;
                }
                value
            }
            Expression::Negative(_) | Expression::Power(_) | Expression::Measure(..) => return None,
        };
        within(value)
    }

    fn constant(&mut self, name: &str, chain: u32) -> Option<f64> {
        if let Some(known) = self.known.get(name) {
            return *known;
        }
        let chain = chain.checked_sub(1)?;
        let tokens = self.constants.get(name).cloned().flatten()?;
        let value = self.value(tokens, chain);
        self.known.insert(name.to_owned(), value);
        value
    }
}

fn computed(left: f64, operator: Operator, right: f64) -> f64 {
    match operator {
        Operator::Add => left + right,
        Operator::Subtract => left - right,
        Operator::Multiply => left * right,
        // A division by zero gives a number that `within` refuses.
        Operator::Divide => (left / right).trunc(),
        Operator::Remainder => left % right,
    }
}

fn within(value: f64) -> Option<f64> {
    (0.0..=VALUE_LIMIT).contains(&value).then_some(value)
}

/// Returns a whole number written in WGSL, with or without a suffix.
fn whole_number(word: &str) -> Option<u64> {
    let digits = word.strip_suffix(['u', 'i']).unwrap_or(word);
    match digits.strip_prefix("0x").or(digits.strip_prefix("0X")) {
        Some(digits) => u64::from_str_radix(digits, 16).ok(),
        None => digits.parse().ok(),
    }
}
