//! Calls with too many numbers
//! Each function calls the one before twice, each time with other numbers.

fn k0(x: i32) -> i32 {
    return x;
}
fn k1(x: i32) -> i32 {
    return k0(x * 2) + k0(x * 2 + 1);
}
fn k2(x: i32) -> i32 {
    return k1(x * 2) + k1(x * 2 + 1);
}
fn k3(x: i32) -> i32 {
    return k2(x * 2) + k2(x * 2 + 1);
}
fn k4(x: i32) -> i32 {
    return k3(x * 2) + k3(x * 2 + 1);
}
fn k5(x: i32) -> i32 {
    return k4(x * 2) + k4(x * 2 + 1);
}
fn k6(x: i32) -> i32 {
    return k5(x * 2) + k5(x * 2 + 1);
}
fn k7(x: i32) -> i32 {
    return k6(x * 2) + k6(x * 2 + 1);
}
fn k8(x: i32) -> i32 {
    return k7(x * 2) + k7(x * 2 + 1);
}
fn k9(x: i32) -> i32 {
    return k8(x * 2) + k8(x * 2 + 1);
}
fn k10(x: i32) -> i32 {
    return k9(x * 2) + k9(x * 2 + 1);
}
fn k11(x: i32) -> i32 {
    return k10(x * 2) + k10(x * 2 + 1);
}
fn k12(x: i32) -> i32 {
    return k11(x * 2) + k11(x * 2 + 1);
}
fn k13(x: i32) -> i32 {
    return k12(x * 2) + k12(x * 2 + 1);
}
fn k14(x: i32) -> i32 {
    return k13(x * 2) + k13(x * 2 + 1);
}
fn k15(x: i32) -> i32 {
    return k14(x * 2) + k14(x * 2 + 1);
}
fn k16(x: i32) -> i32 {
    return k15(x * 2) + k15(x * 2 + 1);
}
fn k17(x: i32) -> i32 {
    return k16(x * 2) + k16(x * 2 + 1);
}
fn k18(x: i32) -> i32 {
    return k17(x * 2) + k17(x * 2 + 1);
}
fn k19(x: i32) -> i32 {
    return k18(x * 2) + k18(x * 2 + 1);
}
fn k20(x: i32) -> i32 {
    return k19(x * 2) + k19(x * 2 + 1);
}
fn k21(x: i32) -> i32 {
    return k20(x * 2) + k20(x * 2 + 1);
}
fn k22(x: i32) -> i32 {
    return k21(x * 2) + k21(x * 2 + 1);
}
fn k23(x: i32) -> i32 {
    return k22(x * 2) + k22(x * 2 + 1);
}
fn k24(x: i32) -> i32 {
    return k23(x * 2) + k23(x * 2 + 1);
}
fn k25(x: i32) -> i32 {
    return k24(x * 2) + k24(x * 2 + 1);
}

/// The mask.
fn mask(at: Surface) -> f32 {
    return f32(k25(1) + i32(at.uv.x));
}
