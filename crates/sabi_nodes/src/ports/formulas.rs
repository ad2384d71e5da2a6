//! Reads the formulas of `@repeat`, `@texel` and `@points`.

use crate::arithmetic::{Expression, Operator, Syntax, SyntaxErrorKind};
use crate::formula::{Formula, Operation};
use crate::kind::{Memory, Param};
use crate::words::{list, nearest};

/// Maximum number of numbers, names and functions in a formula.
const TERM_LIMIT: usize = 64;

/// Functions by name, with the number of their arguments.
const FUNCTIONS: [(&str, Operation, usize); 6] = [
    ("ceil", Operation::Ceil, 1),
    ("sqrt", Operation::Sqrt, 1),
    ("log2", Operation::Log2, 1),
    ("abs", Operation::Abs, 1),
    ("min", Operation::Min, 2),
    ("max", Operation::Max, 2),
];

/// Reads a formula. The error consists of message and advice.
pub(super) fn read_formula(text: &str, params: &[Param]) -> Result<Formula, (String, String)> {
    let is_allowed = |letter: char| is_in_name(letter) || letter.is_whitespace() || "+-*/(),".contains(letter);
    if let Some(letter) = text.chars().find(|letter| !is_allowed(*letter)) {
        let advice = "It is made of numbers, names, `+ - * /`, parentheses and commas.";
        return Err((format!("A formula cannot hold `{letter}`."), advice.to_owned()));
    }
    let syntax = Syntax {
        has_units: false,
        is_in_name,
    };
    let expression = Expression::read(text, 0, syntax).map_err(|mistake| message_of(mistake.kind))?;
    if expression.terms() > TERM_LIMIT {
        return Err(too_long());
    }
    resolve(&expression, params)
}

/// Returns true if a character may be part of a name such as `params.tile_size`.
fn is_in_name(letter: char) -> bool {
    letter.is_ascii_alphanumeric() || letter == '_' || letter == '.'
}

fn message_of(kind: SyntaxErrorKind) -> (String, String) {
    match kind {
        SyntaxErrorKind::UnexpectedEnd => unexpected("The formula ends too early.".to_owned()),
        SyntaxErrorKind::ExpectedNumber(token)
        | SyntaxErrorKind::TrailingText(token)
        | SyntaxErrorKind::BadNumber(token) => unexpected(format!("`{token}` does not fit into the formula.")),
        SyntaxErrorKind::ExpectedParenthesis(_) | SyntaxErrorKind::UnclosedParenthesis => missing_sign(")"),
        SyntaxErrorKind::TooDeep => too_long(),
    }
}

fn too_long() -> (String, String) {
    let message = format!("A formula has at most {TERM_LIMIT} terms.");
    (message, "Make it shorter.".to_owned())
}

fn unexpected(message: String) -> (String, String) {
    (message, "Write it like `ceil(2 * params.radius / texel)`.".to_owned())
}

fn missing_sign(sign: &str) -> (String, String) {
    let advice = "Close every parenthesis, and give each function its arguments.";
    (format!("The formula lacks a `{sign}`."), advice.to_owned())
}

/// Resolves the names and functions of an expression.
fn resolve(expression: &Expression, params: &[Param]) -> Result<Formula, (String, String)> {
    match expression {
        Expression::Number(number) => Ok(Formula::Number(*number)),
        Expression::Name(name) => resolve_name(&name.text, params),
        Expression::Call(name, arguments) => resolve_call(&name.text, arguments, params),
        Expression::Negative(inner) => {
            let of = vec![Formula::Number(0.0), resolve(inner, params)?];
            Ok(Formula::Operation(Operation::Subtract, of))
        }
        Expression::Chain(first, rest) => {
            let mut left = resolve(first, params)?;
            for (sign, right) in rest {
                let operation = match sign {
                    Operator::Add => Operation::Add,
                    Operator::Subtract => Operation::Subtract,
                    Operator::Multiply => Operation::Multiply,
                    Operator::Divide => Operation::Divide,
                    Operator::Remainder => return Err(unexpected("`%` does not fit into the formula.".to_owned())),
                };
                left = Formula::Operation(operation, vec![left, resolve(right, params)?]);
            }
            Ok(left)
        }
        Expression::Power(_) => Err(unexpected("`^` does not fit into the formula.".to_owned())),
        Expression::Measure(_, unit) => Err(unexpected(format!("`{}` does not fit into the formula.", unit.text))),
    }
}

fn resolve_name(name: &str, params: &[Param]) -> Result<Formula, (String, String)> {
    match name {
        "texel" => return Ok(Formula::Texel),
        "finest" => return Ok(Formula::Finest),
        _ => {}
    }
    let Some(name) = name.strip_prefix("params.") else {
        return Err(match FUNCTIONS.iter().any(|(known, ..)| *known == name) {
            true => missing_sign("("),
            false => unknown(name),
        });
    };
    let Some(index) = params.iter().position(|param| param.name == name) else {
        let advice = match nearest(name, params.iter().map(|param| param.name.as_str())) {
            Some(meant) => format!("Did you mean `params.{meant}`?"),
            None => "Name a member of `struct Params`.".to_owned(),
        };
        return Err((
            format!("The formula names a parameter `{name}`, which does not exist."),
            advice,
        ));
    };
    match params[index].ty.memory {
        Memory::F32 | Memory::U32 | Memory::I32 => Ok(Formula::Param(index)),
        _ => Err((
            format!("`params.{name}` is no single number."),
            "A formula takes parameters of the types `f32`, `u32` and `i32`.".to_owned(),
        )),
    }
}

fn resolve_call(name: &str, arguments: &[Expression], params: &[Param]) -> Result<Formula, (String, String)> {
    let Some((_, operation, count)) = FUNCTIONS.iter().find(|(known, ..)| *known == name) else {
        return Err(unknown(name));
    };
    if arguments.len() != *count {
        return Err(missing_sign(if arguments.len() < *count { "," } else { ")" }));
    }
    let of: Result<Vec<Formula>, _> = arguments.iter().map(|argument| resolve(argument, params)).collect();
    Ok(Formula::Operation(*operation, of?))
}

fn unknown(name: &str) -> (String, String) {
    let known = || FUNCTIONS.iter().map(|(known, ..)| *known).chain(["texel", "finest"]);
    let advice = match nearest(name, known()) {
        Some(meant) => format!("Did you mean `{meant}`?"),
        None => format!("It knows {}, and parameters as `params.name`.", list(known())),
    };
    (format!("The formula does not know `{name}`."), advice)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formula::Variables;

    fn value(text: &str) -> f64 {
        let variables = Variables {
            param: &|_| 0.0,
            texel: 0.5,
            finest: 0.25,
        };
        read_formula(text, &[]).unwrap().value(&variables)
    }

    #[test]
    fn products_bind_tighter_than_sums_and_both_are_evaluated_from_left_to_right() {
        assert_eq!(value("1 + 2 * 3 - 4 / 2 - 1"), 4.0);
        assert_eq!(value("(1 + 2) * 3"), 9.0);
        assert_eq!(value("ceil(3 / texel + 0.1)"), 7.0);
        assert_eq!(
            value("max(texel / finest, min(1, 9)) + sqrt(16) + log2(8) + abs(1 - 3)"),
            11.0
        );
    }

    #[test]
    fn a_text_that_is_not_a_formula_is_refused_with_the_reason() {
        let why = |text: &str| read_formula(text, &[]).unwrap_err();
        assert_eq!(why("1 +").0, "The formula ends too early.");
        assert_eq!(why("1 2").0, "`2` does not fit into the formula.");
        assert_eq!(why("(1").0, "The formula lacks a `)`.");
        assert_eq!(why("max(1)").0, "The formula lacks a `,`.");
        assert_eq!(why("2 ^ 3").0, "A formula cannot hold `^`.");
        assert_eq!(why("tezel").1, "Did you mean `texel`?");
        assert_eq!(
            why("params.size").0,
            "The formula names a parameter `size`, which does not exist."
        );
        assert_eq!(why(&"(".repeat(100)).0, "A formula has at most 64 terms.");
        assert_eq!(
            why(&format!("1{}", " + 1".repeat(64))).0,
            "A formula has at most 64 terms."
        );
        assert_eq!(why("max(1, 2, 3)").0, "The formula lacks a `)`.");
        assert_eq!(why("2 * ceil").0, "The formula lacks a `(`.");
    }
}
