//! Results that are read back in bands of rows.

use std::ops::Range;

use sabi_gpu::{BandData, Normals, read_slot, read_slot_in_bands};

use super::*;

/// Side of a plane of numbers that takes two bands; a band has 16 MiB. Its rows of normals are padded by 128 bytes.
const TEXELS: u32 = 2312;

/// All texels of a band.
fn texels_of(band: &Range<usize>, data: &BandData<'_>) -> Vec<[f32; 4]> {
    let mut texels = vec![[0.0; 4]; band.len()];
    data.copy_texels(0..band.len(), &mut texels);
    texels
}

#[test]
fn bands_have_all_texels_and_none_is_larger_than_its_limit() {
    let bench = Bench::new(TEXELS);
    let plan = bench.plan(CHAIN, FUSED);
    let mut run = bench.run(&plan, &options(), None).unwrap();
    let (gpu, surface, slot) = (&bench.gpu, &bench.surface, plan.results[0].slots[0]);
    let whole = read_slot(gpu, surface, &plan, &run, slot).unwrap();
    let options = options();
    let normals_of = Normals {
        gpu,
        surface,
        height: Some(slot),
        slope: None,
        options: &options,
    };
    let normals = normals_of.read(&mut run).unwrap();
    let atlas = Atlas::build(&square(), &AtlasOptions::new(TEXELS)).unwrap();
    assert_eq!(atlas.page_size[0] * 16 % 256, 128, "bytes of a row of normals");
    let is_covered = |texel: &usize| atlas.owners[*texel] != sabi_surface::atlas::EMPTY;
    let mut counts = [Vec::new(), Vec::new()];
    let texels = 0..whole.len();
    read_slot_in_bands(gpu, surface, &plan, &run, slot, &texels, |band, data| {
        assert!(4 * band.len() <= 16 << 20);
        let same = band.clone().map(|texel| whole.texel(texel)).eq(texels_of(band, data));
        assert!(same, "{band:?}");
        counts[0].push(band.len());
    })
    .unwrap();
    let in_bands = normals_of.read_in_bands(&mut run, &texels, |band, data| {
        assert!(16 * band.len() <= 16 << 20);
        let read = band.clone().zip(texels_of(band, data));
        for (texel, normal) in read.filter(|(texel, _)| is_covered(texel)) {
            assert_eq!(normal, normals.texel(texel), "{texel}");
        }
        counts[1].push(band.len());
    });
    in_bands.unwrap();
    assert_eq!(
        counts.each_ref().map(|bands| bands.iter().sum::<usize>()),
        [whole.len(); 2]
    );
    assert!(counts[0].len() == 2 && counts[1].len() > 4, "{counts:?}");
}

#[test]
fn bands_without_a_texel_of_the_range_are_not_read() {
    let bench = Bench::new(TEXELS);
    let plan = bench.plan(CHAIN, FUSED);
    let run = bench.run(&plan, &options(), None).unwrap();
    let mut bands = Vec::new();
    let slot = plan.results[0].slots[0];
    read_slot_in_bands(&bench.gpu, &bench.surface, &plan, &run, slot, &(5..6), |band, _| {
        bands.push(band.start)
    })
    .unwrap();
    assert_eq!(bands, [0]);
}

#[test]
fn a_freed_result_no_longer_counts_as_memory_of_the_run() {
    let bench = Bench::new(64);
    let plan = bench.plan(CHAIN, FUSED);
    let mut run = bench.run(&plan, &options(), None).unwrap();
    let slot = plan.results[0].slots[0];
    let before = run.bytes();
    run.free(&plan, slot);
    assert_eq!(before - run.bytes(), 4 * bench.surface.texels());
    assert!(run.texture(slot).is_err());
}
