//! Code too long
//! Each function calls the one before twice.

fn k0(x: f32) -> f32 {
    return sin(x) * 2.0;
}
fn k1(x: f32) -> f32 {
    return k0(x) + k0(x + 1.0);
}
fn k2(x: f32) -> f32 {
    return k1(x) + k1(x + 1.0);
}
fn k3(x: f32) -> f32 {
    return k2(x) + k2(x + 1.0);
}
fn k4(x: f32) -> f32 {
    return k3(x) + k3(x + 1.0);
}
fn k5(x: f32) -> f32 {
    return k4(x) + k4(x + 1.0);
}
fn k6(x: f32) -> f32 {
    return k5(x) + k5(x + 1.0);
}
fn k7(x: f32) -> f32 {
    return k6(x) + k6(x + 1.0);
}
fn k8(x: f32) -> f32 {
    return k7(x) + k7(x + 1.0);
}
fn k9(x: f32) -> f32 {
    return k8(x) + k8(x + 1.0);
}
fn k10(x: f32) -> f32 {
    return k9(x) + k9(x + 1.0);
}
fn k11(x: f32) -> f32 {
    return k10(x) + k10(x + 1.0);
}
fn k12(x: f32) -> f32 {
    return k11(x) + k11(x + 1.0);
}
fn k13(x: f32) -> f32 {
    return k12(x) + k12(x + 1.0);
}

/// The mask.
fn mask(at: Surface) -> f32 {
    return k13(at.uv.x);
}
