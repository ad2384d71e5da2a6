use super::{read, read_with};
use crate::Library;

/// Reads a mask function with this body. `params` has `steps` 1..16, `signed` -4..4 and `free` without a range.
fn mask(body: &str) -> Result<crate::kind::Kind, String> {
    read(&format!(
        "struct Params {{\n/// S.\n/// @range 1 16 @default 4\nsteps: u32,\n/// T.\n/// @range -4 4 @default 0\nsigned: i32,\n\
         /// F.\n/// @default 4\nfree: u32,\n}}\n{body}"
    ))
}

/// Reads a mask whose body is `sum += 1.0` inside `loops`; a closing brace is added for each opening one.
fn looped(loops: &str) -> Result<Vec<String>, String> {
    let opened = loops.matches('{').count() - loops.matches('}').count();
    let text = format!(
        "fn keep(params: Params) -> f32 {{ return f32(params.steps) + f32(params.signed) + f32(params.free); }}\n\
         /// M.\nfn mask(at: Surface, params: Params) -> f32 {{\nvar sum = keep(params);\n{loops} sum += 1.0; {}\nreturn sum;\n}}\n",
        "}".repeat(opened)
    );
    let bounding = |kind: crate::kind::Kind| {
        let params = kind.params.into_iter().filter(|param| param.bounds_a_loop);
        params.map(|param| param.name).collect()
    };
    mask(&text).map(bounding)
}

#[test]
fn bounds_that_follow_from_the_code_are_found() {
    for (loops, bounding) in [
        ("for (var i = 0; i < 8; i++) {", &[][..]),
        ("for (var i = 0u; i <= 8u; i += 2u) {", &[]),
        ("for (var i = -2; i <= 2; i = i + 1) {", &[]),
        ("for (var i = 0u; 8u > i; i++) {", &[]),
        ("for (var i = 0u; i < params.steps; i++) {", &["steps"]),
        ("for (var i = params.signed; i < 8; i++) {", &["signed"]),
        ("for (var i = 0; i < i32(params.steps); i++) {", &["steps"]),
        ("for (var i = 0u; i < params.steps * 2u + 1u; i++) {", &["steps"]),
        ("for (var i = 0u; i < 1u << min(params.free, 4u); i++) {", &[]),
        ("for (var i = 0u; i < min(params.free, 8u); i++) {", &[]),
        ("for (var i = 0u; i < clamp(params.free, 1u, 8u); i++) {", &[]),
        ("for (var i = 0u; i < params.free % 8u; i++) {", &[]),
        ("for (var i = 0u; i < (params.free & 7u); i++) {", &[]),
        ("let n = min(u32(at.uv.x), 5u);\nfor (var i = 0u; i < n; i++) {", &[]),
        (
            "var n = 3u; if at.uv.x > 0.0 { n = params.steps; }\nfor (var i = 0u; i < n; i++) {",
            &["steps"],
        ),
        (
            "for (var i = 0u; i < select(3u, params.steps, at.uv.x > 0.0); i++) {",
            &["steps"],
        ),
        ("for (var i = 0u; i < 8u && sum < 4.0; i++) {", &[]),
        (
            "for (var i = 0; i < 8; i++) {\nfor (var j = i; j < 8; j++) {\nfor (var k = -j; k <= j; k++) {",
            &[],
        ),
        (
            "for (var i = 0; i < 8; i++) { if sum > 3.0 { continue; } if sum > 5.0 { break; }",
            &[],
        ),
        ("for (var i = 0; i < 0; i++) {", &[]),
        ("for (var i = 5; i < 3; i++) {", &[]),
        ("for (var i = 0u; i < 65535u; i++) {", &[]),
    ] {
        assert_eq!(looped(loops).unwrap(), bounding, "{loops}");
    }
}

#[test]
fn loops_without_a_provable_bound_are_refused() {
    for loops in [
        "loop { if sum > 4.0 { break; }",
        "while sum < 4.0 {",
        "for (;;) { if sum > 4.0 { break; }",
        "for (var i = 0u; i < params.free; i++) {",
        "for (var i = 0u; i < u32(at.uv.x); i++) {",
        "for (var i = 0; i < i32(at.uv.x); i++) {",
        "for (var i = i32(at.uv.x); i < 8; i++) {",
        "for (var i = 0u; i < max(params.free, 8u); i++) {",
        "for (var i = 0u; i < params.steps - 2u; i++) {",
        "for (var i = 0u; i < min(params.free, 8u) * 1000000000u; i++) {",
        "for (var i = 0u; i <= 4294967295u; i++) {",
        "for (var i = 8; i > 0; i--) {",
        "for (var i = 0; i < 8; i--) {",
        "for (var i = 0; i < 8; i += params.signed) {",
        "for (var i = 0; i < 8; i *= 2) {",
        "for (var i = 0; i != 8; i++) {",
        "for (var i = 0; i < 8; i++) { i = 0;",
        "for (var x = 0.0; x < 8.0; x += 1.0) {",
        "for (var i = 0; i < 8 || sum < 4.0; i++) {",
        "var n = 4u; for (var i = 0u; i < n; i++) { n = n + 1u;",
        "for (var i = 0; i < 8; i++) { let p = &i; *p = 0;",
        "loop { if sum > 1.0 { continue; } if sum > 4.0 { break; } continuing { sum += 1.0; break if sum > 3.0; } }\nif true {",
    ] {
        let message = looped(loops).map(|_| loops).unwrap_err();
        assert!(
            message.contains("is not known") || message.contains("no known bound"),
            "{loops}: {message}"
        );
    }
}

#[test]
fn bounds_of_nested_loops_and_calls_are_multiplied() {
    let text = |count: u32| {
        format!(
            "fn inner(n: u32) -> f32 {{ var sum = 0.0; for (var i = 0u; i < n; i++) {{ sum += 1.0; }} return sum; }}\n\
             /// M.\nfn mask(params: Params) -> f32 {{ var sum = f32(params.signed) + f32(params.free); for (var i = 0u; i < params.steps; i++) {{ sum += inner({count}u); }} return sum; }}\n"
        )
    };
    assert!(mask(&text(4096)).is_ok());
    let message = mask(&text(4097)).unwrap_err();
    assert!(message.contains("16 × 4097 = 65552 rounds"), "{message}");
}

#[test]
fn a_loop_in_a_helper_function_is_bounded_by_the_arguments_of_the_call() {
    let text = |argument: &str| {
        format!(
            "fn inner(n: u32) -> f32 {{ var sum = 0.0; for (var i = 0u; i < n; i++) {{ sum += 1.0; }} return sum; }}\n\
             fn outer(params: Params) -> f32 {{ return inner({argument}) + f32(params.signed) + f32(params.free) + f32(params.steps); }}\n\
             /// M.\nfn mask(params: Params) -> f32 {{ return outer(params); }}\n"
        )
    };
    let bounds = |kind: crate::kind::Kind| kind.params[0].bounds_a_loop;
    assert!(bounds(mask(&text("params.steps")).unwrap()));
    assert!(!bounds(mask(&text("12u")).unwrap()));
    assert!(mask(&text("params.free")).unwrap_err().contains("is not known"));
}

#[test]
fn a_tree_of_calls_cannot_grow_without_limit() {
    let levels: String = (1..40)
        .map(|i| {
            format!(
                "fn g{i}(x: f32) -> f32 {{ return g{}(x) + g{}(x + 1.0); }}\n",
                i - 1,
                i - 1
            )
        })
        .collect();
    let text = format!(
        "fn g0(x: f32) -> f32 {{ return x; }}\n{levels}/// M.\nfn mask(at: Surface) -> f32 {{ return g39(at.uv.x); }}\n"
    );
    let message = read(&text).unwrap_err();
    assert!(message.contains("rounds and calls"), "{message}");
}

#[test]
fn loops_of_a_function_that_is_never_called_are_not_checked() {
    let text = "fn idle() -> f32 { var x = 0.0; loop { x += 1.0; if x > 4.0 { break; } } return x; }\n/// M.\nfn mask(at: Surface) -> f32 { return at.uv.x; }\n";
    assert!(read(text).is_ok());
}

#[test]
fn code_that_runs_for_each_ray_is_counted_for_each_ray() {
    let node = |in_ray: u32, of_ray: u32, of_mean: u32| {
        let looped = |rounds: u32| format!("var sum = 0.0; for (var i = 0u; i < {rounds}u; i++) {{ sum += 0.1; }}");
        let text = format!(
            "//! @use rays\n\nstruct Params {{\n/// R.\n/// @range 1 256 @default 8\nrays: u32,\n}}\n\
             /// R.\n/// @rays params.rays\nfn ray(at: Surface, index: u32) -> Ray {{ {} return Ray(at.position, sum + f32(index), at.normal); }}\n\
             /// P.\n/// @pass 1\nfn near(hit: Hit) -> f32 {{ {} return sum * hit.distance; }}\n\
             /// M.\nfn mask(near: f32) -> f32 {{ {} return sum * near; }}\n",
            looped(in_ray),
            looped(of_ray),
            looped(of_mean)
        );
        read_with(&Library::builtin_files().1, &text)
    };
    assert!(node(256, 256, 65536).is_ok());
    for (in_ray, of_ray) in [(257, 1), (1, 257)] {
        let message = node(in_ray, of_ray, 1).map(|_| ()).unwrap_err();
        assert!(
            message.contains("257 rounds and calls for each of up to 256 rays, 65792"),
            "{message}"
        );
    }
    assert!(node(1, 1, 65537).is_err());
}

#[test]
fn a_loop_in_the_continuing_block_of_another_loop_is_checked() {
    let text = |inner: &str| {
        format!(
            "fn put(x: f32) -> f32 {{ {inner} return x; }}\n\
             /// M.\nfn mask(at: Surface) -> f32 {{ var sum = 0.0; var i = 0u;\n\
             loop {{ if i < 8u {{ }} else {{ break; }} continuing {{ sum += put(at.uv.x); i++; }} }}\nreturn sum; }}\n"
        )
    };
    assert!(read(&text("")).is_ok());
    let message = read(&text("loop { if x > 4.0 { break; } }")).unwrap_err();
    assert!(message.contains("no known bound"), "{message}");
    let message = read(&text("var y = x; for (var i = 0; i < 10000; i++) { y += 1.0; }")).unwrap_err();
    assert!(message.contains("8 × 10000 = 80000 rounds"), "{message}");
}

#[test]
fn the_work_counts_what_is_done_in_each_round() {
    let work = |rounds: u32, body: &str| {
        let text = format!(
            "/// M.\nfn mask(at: Surface) -> f32 {{ var x = at.uv.x; for (var i = 0; i < {rounds}; i++) {{ {body} }} return x; }}\n"
        );
        read(&text).map(|kind| kind.work)
    };
    let (once, tenfold) = (work(100, "x += 1.0;").unwrap(), work(1000, "x += 1.0;").unwrap());
    assert!(tenfold > 9 * once && tenfold < 11 * once, "{once} {tenfold}");
    assert!(work(1000, "x = sin(x);").unwrap() > 2 * tenfold);
    assert!(work(60_000, &"x = sin(x); ".repeat(10)).is_ok());
    let message = work(60_000, &"x = sin(x); ".repeat(40)).unwrap_err();
    assert!(
        message.contains("operations for each texel; 16777216 are allowed."),
        "{message}"
    );
}

#[test]
fn of_many_loops_without_a_bound_only_some_are_reported() {
    let loops = "loop { if x > 4.0 { break; } }\n".repeat(2_000);
    let text = format!(
        "//! Test\n//! A test.\n\n/// M.\nfn mask(at: Surface) -> f32 {{ let x = at.uv.x; {loops} return x; }}\n"
    );
    let file = crate::SourceFile {
        path: "test/node.wgsl".into(),
        id: "test/node".to_owned(),
        text,
    };
    let core = Library::builtin_files().1.text("core").unwrap().to_owned();
    let faults = crate::read_kind(&file, &crate::Libraries([("core".to_owned(), core)].into())).unwrap_err();
    assert_eq!(faults.len(), 64);
}
