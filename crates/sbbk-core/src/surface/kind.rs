//! Classification of meshes as solids or sheets.

use std::collections::BTreeMap;

use glamx::{DVec3, Vec3};
use rustc_hash::FxHashMap;

use crate::collections::UnionFind;

/// The kind of surface that a mesh forms.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SurfaceKind {
    /// A body with outward normals, closed or nearly so. It may consist of several components, with
    /// hollows.
    Solid,
    /// A body with inward normals.
    InsideOut,
    /// An open surface, a triangle soup, or triangles that disagree about the outside. It collides on
    /// both sides.
    Sheet,
}

/// Greatest area of all holes of a solid, as a share of its surface; for a hole with a lid the gap
/// counts. Higher: bodies in a vase are pushed out of it. Lower: a head with a hole is a sheet.
const GREATEST_HOLES: f64 = 0.06;

/// Greatest distance of two borders that close each other, as a share of the extent of the mesh.
/// Higher: slits count as closed. Lower: seams count as holes.
const SEAM: f64 = 1.0e-5;

/// Least volume of a solid, as a share of its surface times its extent. Higher: thin plates count as
/// sheets. Lower: sheets of two layers count as solids.
const LEAST_VOLUME: f64 = 1.0e-6;

pub(super) fn classify(
    vertices: &[Vec3],
    triangles: &[[u32; 3]],
    unpaired: &[[u32; 2]],
) -> SurfaceKind {
    let Some(&first) = triangles.first().and_then(|triangle| vertices.get(triangle[0] as usize))
    else {
        return SurfaceKind::Sheet;
    };
    let corner = |index: u32| vertices[index as usize].as_dvec3() - first.as_dvec3();
    let (mut area, mut volume, mut extent) = (0.0, 0.0, 0.0_f64);
    for triangle in triangles {
        let [a, b, c] = triangle.map(corner);
        let twice = (b - a).cross(c - a);
        area += twice.length() / 2.0;
        volume += a.dot(twice) / 6.0;
        extent = extent.max(a.length());
    }
    let borders = loops(&without_seams(unpaired, corner, SEAM * extent));
    let borders = borders.iter().map(|edges| Border::new(edges, corner)).collect();
    let is_closed = hole_area(borders) <= GREATEST_HOLES * area;
    let least = LEAST_VOLUME * area * extent;
    if is_closed && volume > least {
        SurfaceKind::Solid
    } else if is_closed && volume < -least {
        SurfaceKind::InsideOut
    } else {
        SurfaceKind::Sheet
    }
}

/// A loop of border edges.
struct Border {
    middle: DVec3,
    length: f64,
    /// Area of the triangles between the middle and the edges.
    cover: f64,
    /// Vector area of these triangles. Shorter than the cover for a loop around two holes, such as
    /// the border of a tube with a slit.
    area: DVec3,
}

/// Least vector area of a loop around one hole, as a share of its cover. Higher: bent holes need a
/// cover of their own. Lower: the strip between a slit and a hole counts.
const ONE_HOLE: f64 = 0.9;

/// Number of the largest loops that may close each other. Higher: time by its square. Lower: lids of
/// small holes count as holes.
const MOST_LIDS: usize = 32;

impl Border {
    fn new(edges: &[[u32; 2]], corner: impl Fn(u32) -> DVec3) -> Self {
        let starts: DVec3 = edges.iter().map(|&[start, _]| corner(start)).sum();
        let middle = starts / edges.len() as f64;
        let (mut length, mut cover, mut area) = (0.0, 0.0, DVec3::ZERO);
        for [start, end] in edges.iter().map(|edge| edge.map(&corner)) {
            let part = (start - middle).cross(end - middle) / 2.0;
            length += start.distance(end);
            cover += part.length();
            area += part;
        }
        Self { middle, length, cover, area }
    }

    /// Area saved by the strip between this hole and its lid, compared with a cover of each. Zero
    /// unless both loops are holes that run in opposite directions.
    fn area_saved_by(&self, lid: &Self) -> f64 {
        let is_hole = |border: &Self| border.area.length() >= ONE_HOLE * border.cover;
        if !is_hole(self) || !is_hole(lid) {
            return 0.0;
        }
        let apart = 0.5 * (self.length + lid.length) * self.middle.distance(lid.middle);
        self.cover + lid.cover - (self.area + lid.area).length() - apart
    }
}

/// Area that closes all loops: a cover of each, or the strip between a hole and its lid.
fn hole_area(mut borders: Vec<Border>) -> f64 {
    borders.sort_unstable_by(|a, b| b.cover.total_cmp(&a.cover));
    let all: f64 = borders.iter().map(|border| border.cover).sum();
    borders.truncate(MOST_LIDS);
    let pairs = (0..borders.len()).flat_map(|i| (0..i).map(move |j| [i, j]));
    let saved = pairs.map(|[i, j]| (borders[i].area_saved_by(&borders[j]), [i, j]));
    let mut saved: Vec<_> = saved.filter(|(saved, _)| *saved > 0.0).collect();
    saved.sort_unstable_by(|(a, _), (b, _)| b.total_cmp(a));
    let mut is_closed = vec![false; borders.len()];
    let by_lids = saved.into_iter().filter(|(_, pair)| {
        let is_new = pair.iter().all(|&i| !is_closed[i]);
        pair.iter().for_each(|&i| is_closed[i] |= is_new);
        is_new
    });
    all - by_lids.map(|(saved, _)| saved).sum::<f64>()
}

/// The edges without a partner that runs back, after vertices within `distance` are merged.
fn without_seams(
    edges: &[[u32; 2]],
    corner: impl Fn(u32) -> DVec3,
    distance: f64,
) -> Vec<[u32; 2]> {
    let cell = |place: DVec3| (place / distance).floor().to_array().map(|x| x as i64);
    // One vertex of each cell is enough.
    let mut cells: FxHashMap<[i64; 3], u32> = Default::default();
    let mut same: FxHashMap<u32, u32> = Default::default();
    for &vertex in edges.as_flattened() {
        same.entry(vertex).or_insert_with(|| {
            let place = corner(vertex);
            let near =
                (0..8).map(|i| DVec3::from_array([0, 1, 2].map(|axis| f64::from(i >> axis & 1))));
            let near = near.map(|offset| cell(place + distance * (offset - 0.5)));
            let merged = near.filter_map(|cell| cells.get(&cell).copied()).next();
            merged.unwrap_or_else(|| *cells.entry(cell(place)).or_insert(vertex))
        });
    }
    let mut open: BTreeMap<[u32; 2], usize> = Default::default();
    for [a, b] in edges.iter().map(|edge| edge.map(|vertex| same[&vertex])) {
        match open.get_mut(&[b, a]) {
            _ if a == b => {}
            Some(back) if *back > 0 => *back -= 1,
            _ => *open.entry([a, b]).or_default() += 1,
        }
    }
    open.into_iter().flat_map(|(edge, count)| std::iter::repeat_n(edge, count)).collect()
}

/// The connected components of some edges.
fn loops(edges: &[[u32; 2]]) -> Vec<Vec<[u32; 2]>> {
    let mut sets = UnionFind::default();
    edges.iter().for_each(|&[a, b]| sets.join(a, b));
    let mut loops: BTreeMap<u32, Vec<[u32; 2]>> = Default::default();
    for &edge in edges {
        loops.entry(sets.first(edge[0])).or_default().push(edge);
    }
    loops.into_values().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_edge_cancels_one_edge_that_runs_back() {
        // Both ends three times, a little apart.
        let corner = |vertex: u32| DVec3::new(f64::from(vertex % 2), 1e-7 * f64::from(vertex), 0.0);
        let left = |edges: &[[u32; 2]]| {
            without_seams(edges, corner, 1e-5)
                .iter()
                .map(|edge| edge.map(|v| v % 2))
                .collect::<Vec<_>>()
        };
        let (out, back) = ([[0, 1], [2, 3], [4, 5]], [[1, 0], [3, 2], [5, 4]]);
        assert!(left(&[out[0], back[1]]).is_empty());
        assert_eq!(left(&[out[0], back[1], back[2]]), [[1, 0]]);
        assert_eq!(left(&[out[0], out[1], back[2]]), [[0, 1]]);
        assert!(left(&[out[0], back[1], out[2], back[0]]).is_empty());
        assert_eq!(left(&[out[0], out[1]]), [[0, 1]; 2]);
        assert!(left(&[[0, 2]]).is_empty(), "an edge between ends at one place");
    }
}
