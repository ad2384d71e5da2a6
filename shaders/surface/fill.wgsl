//! Constants of the kernels that run over the rows of a table of links.

struct Fill {
    // Rows of the table that are run over.
    ghost_count: u32,
    // 0: only owned texels count, 1: ghosts too.
    with_ghosts: u32,
    // Workgroups along x.
    row_length: u32,
    // Rows of four numbers that the table has for a ghost.
    rows: u32,
}

@group(1) @binding(0) var<uniform> fill: Fill;
