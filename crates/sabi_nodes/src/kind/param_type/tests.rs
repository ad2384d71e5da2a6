use super::*;
use crate::curve::curve_points;

fn ty(role: Role, memory: Memory, default: ParamValue) -> ParamType {
    ParamType::new(role, memory, &default)
}

fn number(range: Option<[f64; 2]>) -> ParamType {
    ParamType {
        range,
        ..ty(Role::Plain, Memory::F32, ParamValue::Floats(vec![0.5]))
    }
}

fn whole(memory: Memory, range: Option<[f64; 2]>) -> ParamType {
    ParamType {
        range,
        ..ty(Role::Plain, memory, ParamValue::Unsigned(3))
    }
}

fn choice() -> ParamType {
    let words = ["soft", "hard"].map(str::to_owned).to_vec();
    ty(Role::Choice(words), Memory::U32, ParamValue::Unsigned(1))
}

fn color() -> ParamType {
    ty(Role::Color, Memory::Vec3, ParamValue::Floats(vec![1.0, 0.0, 1.0]))
}

fn stops() -> ParamType {
    let default = vec![0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 0.1, 0.0, 0.0, 0.0, 2.0];
    ty(Role::Stops, Memory::Points(3), ParamValue::Floats(default))
}

fn curve() -> ParamType {
    let default = curve_points(&[[0.0, 0.1], [1.0, 0.7]], 3);
    ParamType {
        range: Some([-1.0, 1.0]),
        ..ty(Role::Curve, Memory::Points(3), ParamValue::Floats(default))
    }
}

fn vector() -> ParamType {
    ty(Role::Plain, Memory::Vec3, ParamValue::Floats(vec![0.0, 1.0, 0.0]))
}

fn toggle() -> ParamType {
    ty(Role::Toggle, Memory::U32, ParamValue::Unsigned(1))
}

fn text(default: &str) -> ParamType {
    ty(Role::Text, Memory::Text, ParamValue::Text(default.to_owned()))
}

fn json(text: &str) -> Value {
    Value::from_json(text).expect("JSON of the test")
}

#[test]
fn a_default_is_written_in_file_form_and_read_back_unchanged() {
    for (ty, written) in [
        (number(None), "0.5"),
        (ty(Role::Length, Memory::F32, ParamValue::Floats(vec![0.1])), "0.1"),
        (whole(Memory::U32, None), "3"),
        (choice(), "\"hard\""),
        (color(), "\"#ff00ff\""),
        (stops(), "[[0, \"#000000\"], [0.1, \"#ffffff\"]]"),
        (curve(), "[[0, 0.1], [1, 0.7]]"),
        (vector(), "[0, 1, 0]"),
        (toggle(), "true"),
        (text("mask"), "\"mask\""),
    ] {
        assert_eq!(ty.default, json(written));
        let read = ty.read(&ty.default).expect("its own default");
        assert_eq!(write(&ty.role, &read), ty.default);
    }
}

#[test]
fn a_value_outside_of_the_range_is_refused_with_the_range() {
    let ty = number(Some([0.0, 0.3]));
    assert_eq!(ty.read(&json("0.3")), Ok(ParamValue::Floats(vec![0.3])));
    // The product equals 0.3 as an `f32`.
    assert!(ty.takes(&Value::Number(0.1 * 3.0)));
    assert_eq!(ty.read(&json("0.31")), Err("a number from 0 to 0.3".to_owned()));
    assert!(curve().takes(&json("[[0, -1], [1, 1]]")));
    assert!(!curve().takes(&json("[[0, -1], [1, 1.5]]")));
    let rays = whole(Memory::U32, Some([1.0, 16.0]));
    assert_eq!(rays.read(&json("16")), Ok(ParamValue::Unsigned(16)));
    assert_eq!(rays.read(&json("17")), Err("a whole number from 1 to 16".to_owned()));
}

#[test]
fn a_value_of_the_wrong_form_is_refused() {
    for (ty, wrong) in [
        (number(None), "\"0.5\""),
        (number(None), "[0.5]"),
        (whole(Memory::U32, None), "-1"),
        (whole(Memory::U32, None), "0.5"),
        (whole(Memory::U32, None), "4294967296"),
        (whole(Memory::I32, None), "2147483648"),
        (choice(), "\"harder\""),
        (color(), "\"6b3a1e\""),
        (color(), "\"#fff\""),
        (stops(), "[]"),
        (stops(), "[[1.5, \"#000000\"]]"),
        (
            stops(),
            "[[0, \"#000000\"], [0, \"#000000\"], [0, \"#000000\"], [0, \"#000000\"]]",
        ),
        (curve(), "[[0, 1, 2]]"),
        (vector(), "[0, 1]"),
        (vector(), "1"),
        (toggle(), "1"),
        (text(""), "7"),
    ] {
        assert_eq!(ty.read(&json(wrong)), Err(ty.expectation()), "{wrong}");
    }
    assert_eq!(number(None).read(&Value::Number(1e300)), Err("a number".to_owned()));
}

#[test]
fn typed_texts_are_read_according_to_the_type_of_the_parameter() {
    for (ty, typed, value) in [
        (number(None), " 0.25 ", "0.25"),
        (whole(Memory::I32, None), "-7", "-7"),
        (vector(), "0, 1,0.5", "[0, 1, 0.5]"),
        (vector(), "[0, 1, 0.5]", "[0, 1, 0.5]"),
        (toggle(), "on", "true"),
        (toggle(), "false", "false"),
        (color(), "6B3A1E", "\"#6b3a1e\""),
        (color(), "#18f", "\"#1188ff\""),
        (color(), "111111", "\"#111111\""),
        (choice(), "hard", "\"hard\""),
        (text(""), "42", "\"42\""),
        (curve(), "[[0, 0.2], [1, 1]]", "[[0, 0.2], [1, 1]]"),
    ] {
        assert_eq!(ty.parse(typed), Ok(json(value)), "{typed}");
    }
    for (ty, typed) in [
        (number(Some([0.0, 1.0])), "2"),
        (number(None), "much"),
        (number(None), "0,5"),
        (number(None), "inf"),
        (toggle(), "perhaps"),
        (color(), "rust"),
        (choice(), "harder"),
        (stops(), "#ffffff"),
    ] {
        assert_eq!(ty.parse(typed), Err(ty.expectation()), "{typed}");
    }
}

#[test]
fn an_expectation_can_follow_the_word_takes() {
    for (ty, words) in [
        (number(None), "a number"),
        (number(Some([0.0, 1.0])), "a number from 0 to 1"),
        (whole(Memory::U32, None), "a whole number from 0 to 4294967295"),
        (whole(Memory::I32, Some([-4.0, 4.0])), "a whole number from -4 to 4"),
        (vector(), "a list of 3 numbers"),
        (toggle(), "true or false"),
        (choice(), "one of soft, hard"),
        (color(), "a color such as \"#6b3a1e\""),
        (
            stops(),
            "a list of 1 to 3 stops such as [0.5, \"#6b3a1e\"], positions from 0 to 1",
        ),
        (
            curve(),
            "a list of 1 to 3 points such as [0.5, 0.8], both numbers from -1 to 1",
        ),
        (text(""), "a text"),
        (text("mask"), "a text such as \"mask\""),
    ] {
        assert_eq!(ty.expectation(), words);
    }
}

#[test]
fn a_slider_uses_the_soft_ends_or_the_range_or_an_interval_around_the_default() {
    let ty = number(Some([0.0, 4.0]));
    assert_eq!(number(None).slider(), [0.0, 1.0]);
    assert_eq!(ty.slider(), [0.0, 4.0]);
    let soft = Some([1.0, 2.0]);
    assert_eq!(ParamType { soft, ..ty }.slider(), [1.0, 2.0]);
}

#[test]
fn the_nearest_number_is_whole_and_within_the_limits() {
    let ranged = number(Some([0.25, 1.0]));
    assert_eq!([-1.0, 0.6, 7.0].map(|it| ranged.nearest(it)), [0.25, 0.6, 1.0]);
    let unsigned = whole(Memory::U32, None);
    let highest = f64::from(u32::MAX);
    assert_eq!(unsigned.limits(), Some([0.0, highest]));
    assert_eq!([-3.0, 2.5, 1e12].map(|it| unsigned.nearest(it)), [0.0, 3.0, highest]);
    assert_eq!([-1e9, 1e9].map(|it| number(None).nearest(it)), [-1e9, 1e9]);
}
