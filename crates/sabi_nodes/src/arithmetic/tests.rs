use super::*;

const PLAIN: Syntax = Syntax {
    has_units: false,
    is_in_name: |letter| letter.is_ascii_alphanumeric() || letter == '_' || letter == '.',
};

const WITH_UNITS: Syntax = Syntax {
    has_units: true,
    is_in_name: char::is_alphabetic,
};

/// The structure with parentheses around everything.
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
        ("1+2*3", "(1 Plus (2 Times 3))"),
        ("8/4%3", "(8 Over 4 Modulo 3)"),
        ("-2^2", "(-(2 ^ 2))"),
        ("2^3^2", "(2 ^ (3 ^ 2))"),
        ("2^-1", "(2 ^ (-1))"),
        ("(1 − 2)×.5", "((1 Minus 2) Times 0.5)"),
        ("max(1, params.b_2) / texel", "(max(1, params.b_2) Over texel)"),
        ("1.5e-2", "0.015"),
    ] {
        assert_eq!(shown(&Expression::read(text, 0, PLAIN).unwrap()), structure, "{text}");
    }
}

#[test]
fn a_unit_is_that_of_the_product_in_front_of_it() {
    for (text, structure) in [
        ("1/2 cm", "((1 Over 2) [cm])"),
        ("2 cm*3", "((2 [cm]) Times 3)"),
        ("2 m + 3cm", "((2 [m]) Plus (3 [cm]))"),
    ] {
        assert_eq!(
            shown(&Expression::read(text, 0, WITH_UNITS).unwrap()),
            structure,
            "{text}"
        );
    }
}

#[test]
fn a_mistake_has_a_place_and_a_kind() {
    let token = str::to_owned;
    for (text, at, kind) in [
        ("1 +", 4, MistakeKind::Ends),
        ("2 * $", 5, MistakeKind::NoNumber(token("$"))),
        ("1 23", 3, MistakeKind::Behind(token("23"))),
        ("1)", 2, MistakeKind::Behind(token(")"))),
        ("(1, 2)", 3, MistakeKind::InParentheses(token(","))),
        ("2*(1", 3, MistakeKind::NotClosed),
        ("1.2.3", 1, MistakeKind::BadNumber(token("1.2.3"))),
    ] {
        assert_eq!(Expression::read(text, 0, PLAIN), Err(Mistake { at, kind }), "{text}");
    }
}

#[test]
fn neither_depth_nor_length_takes_the_stack() {
    for text in ["(", "-", "1^", "sin("].map(|part| part.repeat(100_000)) {
        let kind = Expression::read(&text, 0, PLAIN).map_err(|mistake| mistake.kind);
        assert_eq!(kind, Err(MistakeKind::TooDeep));
    }
    let long = format!("1{}", "+1*1".repeat(100_000));
    assert_eq!(Expression::read(&long, 0, PLAIN).unwrap().terms(), 200_001);
}
