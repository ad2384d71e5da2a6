//! Arithmetic typed where a number is expected: `2*0.3`, `sqrt(2)`, `pi/4`, `3.4 cm`, and `*=2` for the present number.

#[cfg(test)]
mod tests;

use std::f64::consts;

use sabi_nodes::arithmetic::{DEPTH_LIMIT, Expression, Operator, Syntax, SyntaxErrorKind, Word};

/// Units that may stand behind a number, and the measure of angles.
#[derive(Clone, Copy, Debug)]
pub(super) struct Units<'u> {
    /// Names, and the factor to the unit of the knob.
    pub(super) named: &'u [(&'static str, f64)],
    /// Radians in one of the angles that `sin`, `cos` and `tan` take.
    pub(super) angle: f64,
}

impl Units<'_> {
    /// Plain numbers; angles in radians.
    pub(super) const NONE: Units<'static> = Units { named: &[], angle: 1.0 };
    /// Angles in degrees, as knobs of angles hold them.
    pub(super) const DEGREES: Units<'static> = Units {
        named: &[("deg", 1.0), ("°", 1.0), ("rad", 180.0 / consts::PI)],
        angle: consts::PI / 180.0,
    };
}

/// Error in a text that should be a number, with its character, counted from 1.
#[derive(Debug, PartialEq)]
struct ExpressionError {
    at: usize,
    text: String,
}

/// Evaluates a text. `present` is the number that `+=`, `-=`, `*=` and `/=` start from, if there is a single one.
///
/// The error is a sentence.
pub(super) fn evaluate(text: &str, present: Option<f64>, units: Units<'_>) -> Result<f64, String> {
    let text = text.trim();
    let relative = ["+=", "-=", "*=", "/="].iter().find(|sign| text.starts_with(**sign));
    // As in spreadsheets, a sum may begin with a sign of equality.
    let skipped = relative.map_or(usize::from(text.starts_with('=')), |sign| sign.len());
    let number = number(text, skipped, units);
    let number = number.map_err(|mistake| format!("{} (character {}).", mistake.text, mistake.at))?;
    let result = match (relative, present) {
        (None, _) => number,
        (Some(_), None) => {
            return Err(
                "The selected nodes differ here, so there is no one number to start from: type it whole.".into(),
            );
        }
        (Some(sign), Some(present)) => match *sign {
            "+=" => present + number,
            "-=" => present - number,
            "*=" => present * number,
            _ => present / number,
        },
    };
    if result.is_finite() {
        Ok(result)
    } else {
        Err("This has no finite result: something is divided by zero, or is too large, or has no root.".to_owned())
    }
}

fn number(text: &str, skipped: usize, units: Units<'_>) -> Result<f64, ExpressionError> {
    let syntax = Syntax {
        has_units: true,
        is_in_name: |letter| letter.is_alphabetic() || letter == '°',
    };
    let expression = Expression::read(text, skipped, syntax).map_err(|mistake| ExpressionError {
        at: mistake.at,
        text: sentence_of(mistake.kind),
    })?;
    value(&expression, units)
}

fn sentence_of(kind: SyntaxErrorKind) -> String {
    match kind {
        SyntaxErrorKind::UnexpectedEnd => "A number is missing".to_owned(),
        SyntaxErrorKind::ExpectedNumber(token) => format!("`{token}` stands where a number is missing"),
        SyntaxErrorKind::TrailingText(token) => match token.as_str() {
            "," => "Decimals are written with a point, as in 0.5".to_owned(),
            ")" => "This `)` closes nothing".to_owned(),
            token => format!("`{token}` cannot stand here"),
        },
        SyntaxErrorKind::ExpectedParenthesis(token) => match token.as_str() {
            "," => "This `,` separates nothing: decimals are written with a point".to_owned(),
            token => format!("`{token}` cannot stand here"),
        },
        SyntaxErrorKind::UnclosedParenthesis => "This `(` is not closed".to_owned(),
        SyntaxErrorKind::BadNumber(token) => format!("`{token}` is not a number"),
        SyntaxErrorKind::TooDeep => format!("No more than {DEPTH_LIMIT} signs and parentheses fit within one another"),
    }
}

fn value(expression: &Expression, units: Units<'_>) -> Result<f64, ExpressionError> {
    Ok(match expression {
        Expression::Number(number) => *number,
        Expression::Name(name) => constant(name)?,
        Expression::Call(name, arguments) => {
            let given: Result<Vec<f64>, ExpressionError> =
                arguments.iter().map(|argument| value(argument, units)).collect();
            apply(name, &given?, units.angle)?
        }
        Expression::Negative(inner) => -value(inner, units)?,
        Expression::Power(both) => {
            let [base, exponent] = both.as_ref();
            value(base, units)?.powf(value(exponent, units)?)
        }
        Expression::Chain(first, rest) => {
            let mut result = value(first, units)?;
            for (sign, right) in rest {
                let right = value(right, units)?;
                match sign {
                    Operator::Add => result += right,
                    Operator::Subtract => result -= right,
                    Operator::Multiply => result *= right,
                    Operator::Divide => result /= right,
                    Operator::Remainder => result %= right,
                }
            }
            result
        }
        Expression::Measure(inner, unit) => value(inner, units)? * factor(unit, units)?,
    })
}

fn factor(unit: &Word, units: Units<'_>) -> Result<f64, ExpressionError> {
    let known = units.named.iter().find(|(name, _)| *name == unit.text);
    let unknown = || match units.named {
        [] => format!("`{}` cannot stand here: this number has no unit", unit.text),
        named => format!("`{}` is none of the units {}", unit.text, names(named)),
    };
    known.map(|(_, factor)| *factor).ok_or_else(|| at(unit, unknown()))
}

fn constant(name: &Word) -> Result<f64, ExpressionError> {
    match name.text.as_str() {
        "pi" | "π" => Ok(consts::PI),
        "tau" => Ok(consts::TAU),
        "e" => Ok(consts::E),
        _ => Err(unknown(name)),
    }
}

const FUNCTIONS: &str = "sin, cos, tan, sqrt, abs, floor, ceil, round, min, max and pow";

fn unknown(name: &Word) -> ExpressionError {
    at(
        name,
        format!("`{}` is not known here: there are pi, tau, e, {FUNCTIONS}", name.text),
    )
}

fn at(word: &Word, text: String) -> ExpressionError {
    ExpressionError { at: word.at, text }
}

/// The value of a function of some numbers.
fn apply(name: &Word, given: &[f64], angle: f64) -> Result<f64, ExpressionError> {
    let takes = |what: &str| at(name, format!("`{}` takes {what}", name.text));
    let one = || match given {
        [one] => Ok(*one),
        _ => Err(takes("one number")),
    };
    Ok(match name.text.as_str() {
        "sin" => (one()? * angle).sin(),
        "cos" => (one()? * angle).cos(),
        "tan" => (one()? * angle).tan(),
        "sqrt" => one()?.sqrt(),
        "abs" => one()?.abs(),
        "floor" => one()?.floor(),
        "ceil" => one()?.ceil(),
        "round" => one()?.round(),
        "min" => given.iter().copied().fold(f64::INFINITY, f64::min),
        "max" => given.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        "pow" => match given {
            [base, exponent] => base.powf(*exponent),
            _ => return Err(takes("two numbers")),
        },
        _ => return Err(unknown(name)),
    })
}

fn names(units: &[(&'static str, f64)]) -> String {
    let names: Vec<&str> = units.iter().map(|(name, _)| *name).collect();
    names.join(", ")
}
