use super::*;

const PLAIN: Syntax = Syntax {
    has_units: false,
    is_in_name: |letter| letter.is_ascii_alphanumeric() || letter == '_' || letter == '.',
};

const WITH_UNITS: Syntax = Syntax {
    has_units: true,
    is_in_name: char::is_alphabetic,
};

/// Formats the structure with parentheses around every operation.
fn shown(expression: &Expression) -> String {
    match expression {
        Expression::Number(number) => number.to_string(),
        Expression::Name(name) => name.text.clone(),
        Expression::Call(name, arguments) => {
            let arguments: Vec<String> = arguments.iter().map(shown).collect();
            format!("{}({})", name.text, arguments.join(", "))
        }
        Expression::Negative(inner) => format!("(-{})", shown(inner)),
        Expression::Power(both) => format!("({} ^ {})", shown(&both[0]), shown(&both[1])),
        Expression::Chain(first, rest) => {
            let rest: Vec<String> = rest
                .iter()
                .map(|(sign, part)| format!(" {sign:?} {}", shown(part)))
                .collect();
            format!("({}{})", shown(first), rest.concat())
        }
        Expression::Measure(inner, unit) => format!("({} [{}])", shown(inner), unit.text),
    }
}

#[test]
fn powers_bind_tighter_than_signs_products_and_sums() {
    for (text, structure) in [
        ("1+2*3", "(1 Add (2 Multiply 3))"),
        ("8/4%3", "(8 Divide 4 Remainder 3)"),
        ("-2^2", "(-(2 ^ 2))"),
        ("2^3^2", "(2 ^ (3 ^ 2))"),
        ("2^-1", "(2 ^ (-1))"),
        ("(1 − 2)×.5", "((1 Subtract 2) Multiply 0.5)"),
        ("max(1, params.b_2) / texel", "(max(1, params.b_2) Divide texel)"),
        ("1.5e-2", "0.015"),
    ] {
        assert_eq!(shown(&Expression::read(text, 0, PLAIN).unwrap()), structure, "{text}");
    }
}

#[test]
fn a_unit_applies_to_the_whole_product_in_front_of_it() {
    for (text, structure) in [
        ("1/2 cm", "((1 Divide 2) [cm])"),
        ("2 cm*3", "((2 [cm]) Multiply 3)"),
        ("2 m + 3cm", "((2 [m]) Add (3 [cm]))"),
    ] {
        assert_eq!(
            shown(&Expression::read(text, 0, WITH_UNITS).unwrap()),
            structure,
            "{text}"
        );
    }
}

#[test]
fn a_syntax_error_has_a_place_and_a_kind() {
    let token = str::to_owned;
    for (text, at, kind) in [
        ("1 +", 4, SyntaxErrorKind::UnexpectedEnd),
        ("2 * $", 5, SyntaxErrorKind::ExpectedNumber(token("$"))),
        ("1 23", 3, SyntaxErrorKind::TrailingText(token("23"))),
        ("1)", 2, SyntaxErrorKind::TrailingText(token(")"))),
        ("(1, 2)", 3, SyntaxErrorKind::ExpectedParenthesis(token(","))),
        ("2*(1", 3, SyntaxErrorKind::UnclosedParenthesis),
        ("1.2.3", 1, SyntaxErrorKind::BadNumber(token("1.2.3"))),
    ] {
        assert_eq!(
            Expression::read(text, 0, PLAIN),
            Err(SyntaxError { at, kind }),
            "{text}"
        );
    }
}

#[test]
fn long_or_deeply_nested_texts_do_not_exhaust_the_stack() {
    for text in ["(", "-", "1^", "sin("].map(|part| part.repeat(100_000)) {
        let kind = Expression::read(&text, 0, PLAIN).map_err(|mistake| mistake.kind);
        assert_eq!(kind, Err(SyntaxErrorKind::TooDeep));
    }
    let long = format!("1{}", "+1*1".repeat(100_000));
    assert_eq!(Expression::read(&long, 0, PLAIN).unwrap().terms(), 200_001);
}
