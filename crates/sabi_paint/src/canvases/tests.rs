//! Kept canvases give the same result as painting everything from the beginning.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use glam::DVec3;
use sabi_files::Disk;
use sabi_surface::atlas::AtlasOptions;
use sabi_surface::model::Mesh;
use sabi_surface::patch::Site;

use super::*;
use crate::tips::{Tip, random};
use crate::{Action, Area, Brush, StampPictures, Step, StrokeBook, StrokeGroup, SurfaceIndex, Version, file};

const ALL: CanvasLayers = CanvasLayers {
    value: true,
    color: true,
    height: true,
    direction: true,
};
/// Slightly more than two canvases, so that most are forgotten.
const BUDGET: usize = 60 << 10;
/// Maximum number of strokes of a list.
const MOST: usize = 12;
const OPERATIONS: u32 = 10_000;

/// Random numbers of one operation, the same each time.
struct OperationRandom {
    operation: u32,
    asked: i32,
}

impl OperationRandom {
    fn share(&mut self) -> f64 {
        self.asked += 1;
        random(self.operation, [self.asked, 11, 12])
    }

    fn below(&mut self, end: usize) -> usize {
        ((self.share() * end as f64) as usize).min(end.saturating_sub(1))
    }

    fn pick<T: Copy>(&mut self, from: &[T]) -> T {
        from[self.below(from.len())]
    }
}

/// A square of two triangles that covers most of the texture.
fn square() -> Mesh {
    let corners = [[0.1, 0.1], [0.9, 0.1], [0.9, 0.9], [0.1, 0.9]];
    Mesh {
        positions: corners.map(|[x, y]| [x, 1.0 - y, 0.0]).to_vec(),
        normals: vec![[0.0, 0.0, 1.0]; 4],
        tangents: vec![[1.0, 0.0, 0.0, 1.0]; 4],
        uvs: corners.to_vec(),
        uv_set: Some(0),
        triangles: vec![[0, 2, 1], [0, 3, 2]],
        triangle_material: vec![0, 0],
        triangle_part: vec![0, 0],
        ..Mesh::default()
    }
}

fn brush(dice: &mut OperationRandom) -> Brush {
    let tips = [Tip::Round, Tip::Soft, Tip::Square, Tip::Chalk, Tip::Flakes, Tip::Leaks];
    let mut brush = Brush::default().with_tip(dice.pick(&tips));
    brush.radius = 0.05 + 0.2 * dice.share() as f32;
    brush.spacing = 0.5 + dice.share() as f32;
    brush.flow = 0.3 + 0.7 * dice.share() as f32;
    brush.value = dice.share() as f32;
    brush.height = dice.share() as f32 - 0.5;
    brush.color = [dice.share() as f32, 0.5, 0.0];
    brush.symmetry.mirrors[0] = dice.below(8) == 0;
    brush
}

fn stroke(surface: &PaintSurface<'_>, dice: &mut OperationRandom) -> Stroke {
    let points = (0..1 + dice.below(3)).filter_map(|index| {
        let [x, y] = [dice.share(), dice.share()].map(|share| 0.1 + 0.8 * share);
        let site = Site {
            triangle: u32::from(x + y < 1.0),
            position: DVec3::new(x, y, 0.0),
        };
        surface.point(site, dice.share() as f32, index == 0)
    });
    let points: Vec<_> = points.collect();
    let actions = [
        Action::Paint,
        Action::Paint,
        Action::Erase,
        Action::Smear,
        Action::Blur,
        Action::Sharpen,
    ];
    let group = StrokeGroup {
        number: 1,
        name: String::new(),
        opacity: 0.5,
        is_hidden: false,
    };
    Stroke {
        group: (dice.below(4) == 0).then(|| Arc::new(group)),
        action: dice.pick(&actions),
        area: dice.pick(&[Area::Way, Area::Way, Area::Way, Area::Decal, Area::Gradient, Area::All]),
        ..Stroke::new(brush(dice), points)
    }
}

/// Returns a step from a list to another list.
fn step(surface: &PaintSurface<'_>, list: &StrokeList, dice: &mut OperationRandom) -> Step {
    if list.strokes.is_empty() || (list.strokes.len() < MOST && dice.below(3) > 0) {
        return Step::Add(Arc::new(stroke(surface, dice)));
    }
    let own = &list.strokes[dice.below(list.strokes.len())];
    let id = own.id;
    match dice.below(6) {
        0 => Step::Remove(vec![id]),
        1 => Step::Move {
            stroke: id,
            to: dice.below(MOST),
        },
        2 => Step::Place {
            stroke: id,
            points: stroke(surface, dice).points,
            path: None,
            eye: None,
            stencil: None,
        },
        3 => Step::Change {
            stroke: id,
            name: String::new(),
            brush: Box::new(own.brush.clone()),
            is_hidden: !own.is_hidden,
        },
        4 => {
            let from = dice.below(list.strokes.len());
            let members = &list.strokes[from..list.strokes.len().min(from + 4)];
            let group = StrokeGroup {
                number: 1 + dice.below(2) as u32,
                name: String::new(),
                opacity: dice.share() as f32,
                is_hidden: false,
            };
            Step::Group {
                strokes: members.iter().map(|stroke| stroke.id).collect(),
                group: (dice.below(4) > 0).then(|| Arc::new(group)),
            }
        }
        _ => Step::Change {
            stroke: id,
            name: "changed".to_owned(),
            brush: Box::new(brush(dice)),
            is_hidden: own.is_hidden,
        },
    }
}

/// Hash of all layers of a canvas.
fn hash(canvas: &Canvas) -> blake3::Hash {
    let mut hash = blake3::Hasher::new();
    for texel in canvas.texels() {
        hash.update(&texel.cover.to_le_bytes());
        hash.update(&texel.value.to_le_bytes());
        for number in texel.color.iter().chain(&texel.direction).chain([&texel.height]) {
            hash.update(&number.to_le_bytes());
        }
    }
    hash.finalize()
}

#[test]
fn ten_thousand_random_edits_undos_and_reopenings_give_the_same_paint_for_the_same_version() {
    let mesh = square();
    let (index, atlas) = (
        SurfaceIndex::new(&mesh),
        Atlas::build(&mesh, &AtlasOptions::new(24)).unwrap(),
    );
    let surface = PaintSurface::new(&mesh, &index);
    let pictures = StampPictures::new();
    let supplies = Supplies::of_pictures(&pictures);
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("square.strokes");
    let (mut book, mut canvases) = (StrokeBook::default(), Canvases::default());
    let mut stored = BTreeSet::new();
    let mut seen: BTreeMap<Version, blake3::Hash> = BTreeMap::new();
    let (mut history, mut at) = (vec![Version::EMPTY], 0);
    let (mut undone, mut reopened) = (0, 0);
    for operation in 0..OPERATIONS {
        let mut dice = OperationRandom { operation, asked: 0 };
        match dice.below(8) {
            0 | 1 if at > 0 => {
                at -= 1;
                undone += 1;
            }
            2 if at + 1 < history.len() => at += 1,
            3 if dice.below(12) == 0 && history[at] != Version::EMPTY => {
                // The steps to the last version lead through all versions.
                let last = history[history.len() - 1];
                file::store(&Disk::default(), &file, "square", &book, last, &mut stored).unwrap();
                (book, canvases) = (StrokeBook::default(), Canvases::default());
                let bytes = std::fs::read(&file).unwrap();
                assert_eq!(file::read(&bytes, &mut book).unwrap().damaged_bytes, 0);
                reopened += 1;
            }
            _ => {
                let list = book.list(history[at]).unwrap();
                let version = book.push(history[at], &step(&surface, &list, &mut dice));
                history.truncate(at + 1);
                history.push(version);
                at += 1;
            }
        }
        let list = book.list(history[at]).unwrap();
        let layers = ALL;
        let painted = canvases.painted(&surface, &atlas, [0; 32], &list, supplies, layers, BUDGET);
        let found = hash(&painted.canvas);
        assert_eq!(
            *seen.entry(history[at]).or_insert(found),
            found,
            "operation {operation}"
        );
        if operation % 97 == 0 {
            let anew = Canvases::default().painted(&surface, &atlas, [0; 32], &list, supplies, ALL, BUDGET);
            assert_eq!(hash(&anew.canvas), found, "operation {operation}, painted anew");
        }
    }
    assert!(undone > 1000 && reopened > 20, "{undone} undone, {reopened} reopened");
}

#[test]
fn painting_can_be_stopped_anywhere_and_keeps_nothing() {
    let mesh = square();
    let (index, atlas) = (
        SurfaceIndex::new(&mesh),
        Atlas::build(&mesh, &AtlasOptions::new(64)).unwrap(),
    );
    let whole = PaintSurface::new(&mesh, &index);
    let mut dice = OperationRandom { operation: 3, asked: 0 };
    let strokes = (0..40).map(|number| {
        Arc::new(Stroke {
            id: Version([number; 8]),
            ..stroke(&whole, &mut dice)
        })
    });
    let list = StrokeList {
        strokes: strokes.collect(),
    };
    let pictures = StampPictures::new();
    let painted = |canvases: &mut Canvases, surface: &PaintSurface<'_>| {
        let supplies = Supplies::of_pictures(&pictures);
        let painted = canvases.painted(surface, &atlas, [0; 32], &list, supplies, ALL, BUDGET);
        hash(&painted.canvas)
    };
    let wanted = painted(&mut Canvases::default(), &whole);
    for after in [0, 1, 10, 100, 300, 2000] {
        let asked = AtomicUsize::new(0);
        let stop = || asked.fetch_add(1, Ordering::Relaxed) >= after;
        let mut canvases = Canvases::default();
        painted(&mut canvases, &PaintSurface::new(&mesh, &index).stopped_by(&stop));
        let most = asked.into_inner();
        assert!(most < after + 5000, "asked {most} times, and stopped after {after}");
        if most > after {
            assert!(canvases.kept.iter().all(|kept| kept.strokes.len() < list.strokes.len()));
            assert!(canvases.growing.is_empty());
        }
        assert_eq!(painted(&mut canvases, &whole), wanted, "stopped after {after}");
    }
}

#[test]
fn kept_canvases_stay_within_their_budget_and_count_shared_tiles_once() {
    let mesh = square();
    let (index, atlas) = (
        SurfaceIndex::new(&mesh),
        Atlas::build(&mesh, &AtlasOptions::new(256)).unwrap(),
    );
    let surface = PaintSurface::new(&mesh, &index);
    let mut dice = OperationRandom { operation: 7, asked: 0 };
    let mut list = StrokeList::default();
    let mut canvases = Canvases::default();
    let layers = CanvasLayers {
        value: true,
        ..CanvasLayers::default()
    };
    let counted = |canvases: &Canvases| {
        let mut tiles = BTreeSet::new();
        let canvases = canvases
            .kept
            .iter()
            .flat_map(|kept| kept.layered.canvases().chain([&*kept.shown]));
        let all = canvases.flat_map(|canvas| canvas.tile_addresses());
        all.filter(|(address, _)| tiles.insert(*address))
            .map(|(_, bytes)| bytes)
            .sum::<usize>()
    };
    // Several canvases, each of which consists of up to three while a faint group is open.
    let budget = 4 << 20;
    for number in 0..200 {
        list.strokes.push(Arc::new(Stroke {
            id: Version([number; 8]),
            ..stroke(&surface, &mut dice)
        }));
        canvases.painted(
            &surface,
            &atlas,
            [0; 32],
            &list,
            Supplies::of_pictures(&StampPictures::new()),
            layers,
            budget,
        );
        let bytes = counted(&canvases);
        assert!(
            bytes <= canvases.bytes && canvases.bytes <= budget,
            "{bytes} {} of {budget}",
            canvases.bytes
        );
    }
    assert!(
        canvases.kept.len() > 2 && canvases.kept.len() < 200,
        "{}",
        canvases.kept.len()
    );
}

/// Returns the cover in the middle of the square after fills of the whole square in one group, each with its action and the
/// opacity of its brush.
fn cover_under(fills: &[(Action, f32)], group: &StrokeGroup) -> f32 {
    let mesh = square();
    let (index, atlas) = (
        SurfaceIndex::new(&mesh),
        Atlas::build(&mesh, &AtlasOptions::new(24)).unwrap(),
    );
    let surface = PaintSurface::new(&mesh, &index);
    let site = Site {
        triangle: 0,
        position: DVec3::new(0.6, 0.4, 0.0),
    };
    let strokes = fills.iter().map(|(action, opacity)| {
        let brush = Brush {
            opacity: *opacity,
            ..Brush::default()
        };
        Arc::new(Stroke {
            action: *action,
            area: Area::All,
            group: Some(Arc::new(group.clone())),
            ..Stroke::new(brush, vec![surface.point(site, 1.0, true).unwrap()])
        })
    });
    let list = StrokeList {
        strokes: strokes.collect(),
    };
    let painted = Canvases::default().painted(
        &surface,
        &atlas,
        [0; 32],
        &list,
        Supplies::of_pictures(&StampPictures::new()),
        ALL,
        BUDGET,
    );
    painted.canvas.texel(12 * 24 + 12).cover
}

#[test]
fn the_opacity_of_a_group_is_applied_once_to_all_its_strokes_together() {
    use Action::{Erase, Paint};
    let of = |opacity: f32, is_hidden: bool| StrokeGroup {
        number: 1,
        name: String::new(),
        opacity,
        is_hidden,
    };
    for (claim, fills, group, expected) in [
        (
            "one that is in full changes nothing",
            &[(Paint, 0.8)][..],
            of(1.0, false),
            0.8,
        ),
        (
            "a single stroke is as much fainter",
            &[(Paint, 0.8)],
            of(0.5, false),
            0.4,
        ),
        (
            "strokes do not add up beyond it",
            &[(Paint, 1.0), (Paint, 1.0)],
            of(0.5, false),
            0.5,
        ),
        (
            "strokes add up within it",
            &[(Paint, 0.5), (Paint, 0.5)],
            of(0.5, false),
            0.375,
        ),
        (
            "it erases within it in full",
            &[(Paint, 1.0), (Erase, 1.0)],
            of(0.5, false),
            0.0,
        ),
        ("a hidden one leaves nothing", &[(Paint, 1.0)], of(0.5, true), 0.0),
        ("no opacity leaves nothing", &[(Paint, 1.0)], of(0.0, false), 0.0),
        (
            "a number that is none counts as 1",
            &[(Paint, 0.8)],
            of(f32::NAN, false),
            0.8,
        ),
    ] {
        let found = cover_under(fills, &group);
        assert!((found - expected).abs() < 1e-6, "{claim}: {found}");
    }
}
