//! Argument too large
//! An argument of 17 KiB.

struct Table {
    rows: array<vec4f, 1088>,
}

fn row(table: Table, at: u32) -> f32 {
    return table.rows[at].x;
}

/// The mask.
fn mask(at: Surface) -> f32 {
    return row(Table(), u32(at.uv.x));
}
