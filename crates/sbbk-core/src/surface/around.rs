use glamx::{DVec3, Vec3};

use super::Surface;
use crate::contact::Feature;

/// Which triangles of a mesh share edges. Half-edge `3 t + i` runs from vertex `i` of triangle `t`
/// to the next one.
pub trait Twins {
    /// The half-edge that runs back in the neighbour, if there is exactly one.
    fn twin(&self, half_edge: u32) -> Option<u32>;
}

impl Twins for Surface {
    #[inline]
    fn twin(&self, half_edge: u32) -> Option<u32> {
        self.twins.get(half_edge)
    }
}

/// A mesh and how its triangles hang together.
#[derive(Clone, Copy)]
pub struct Around<'a> {
    /// The neighbours of the triangles of this mesh.
    pub twins: &'a dyn Twins,
    /// Whether the mesh is a solid.
    pub is_solid: bool,
    /// The vertices of the mesh.
    pub vertices: &'a [Vec3],
    /// The triangles of the mesh.
    pub triangles: &'a [[u32; 3]],
}

/// How a direction leaves a feature of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// All triangles around the feature lie behind it: what is out there is nowhere nearer. Of a
    /// solid, it leads out.
    Front,
    /// Into a solid.
    Behind,
    /// Neither: a neighbour is nearer.
    Beside,
}

/// How far a neighbour may rise towards a direction before it is nearer, as a sine. Higher: bodies
/// feel the edges between facets. Lower: a face that lies on another, not quite flat, loses part
/// of its contacts.
const RISE: f64 = 0.05;

/// The same where the other surface is a face. Higher: edges within a floor stop what slides over it.
/// Lower: of a body that rocks from point to point, the next one comes as a surprise.
const RISE_ON_FACE: f64 = 0.3;

impl Around<'_> {
    /// Where a unit direction leads from a point of a feature of a triangle, if it is that to the
    /// nearest point of something else: across the face, from an edge, or from a vertex into its
    /// Voronoi cell.
    pub fn side(&self, triangle: u32, feature: Feature, direction: DVec3) -> Side {
        self.look(triangle, feature, direction, RISE, !self.is_solid)
    }

    /// The same for a feature that a face is next to: it may be held up there, though a neighbour is a
    /// little nearer.
    pub fn side_on_face(&self, triangle: u32, feature: Feature, direction: DVec3) -> Side {
        self.look(triangle, feature, direction, RISE_ON_FACE, !self.is_solid)
    }

    /// Whether [`side`](Self::side) is the front, at less cost.
    pub fn is_front(&self, triangle: u32, feature: Feature, direction: DVec3) -> bool {
        self.look(triangle, feature, direction, RISE, true) == Side::Front
    }

    /// The side. If it cannot be the front, `is_hasty` takes it to be beside.
    fn look(
        &self,
        triangle: u32,
        feature: Feature,
        direction: DVec3,
        rise: f64,
        is_hasty: bool,
    ) -> Side {
        let half_edge = match feature {
            Feature::Face => return self.side_of_face(triangle, direction),
            Feature::Edge(i) | Feature::Vertex(i) => 3 * triangle + u32::from(i),
        };
        let mut fan = Fan { rises: false, normal: DVec3::ZERO, direction, rise, is_hasty };
        match feature {
            Feature::Edge(_) => {
                self.add(half_edge, &mut fan);
                if let Some(twin) = self.twins.twin(half_edge) {
                    self.add(twin, &mut fan);
                }
            }
            _ => self.add_around(half_edge, &mut fan),
        }
        if fan.is_done() {
            Side::Beside
        } else if self.is_solid && fan.normal.dot(direction) < 0.0 {
            Side::Behind
        } else if fan.rises {
            Side::Beside
        } else {
            Side::Front
        }
    }

    fn side_of_face(&self, triangle: u32, direction: DVec3) -> Side {
        let [a, b, c] = self.corners(3 * triangle);
        let normal = (b - a).cross(c - a);
        let height = normal.dot(direction);
        if height.abs() <= (1.0 - RISE) * normal.length() {
            Side::Beside
        } else if self.is_solid && height < 0.0 {
            Side::Behind
        } else {
            Side::Front
        }
    }

    /// Adds the triangles around the vertex that a half-edge starts at.
    fn add_around(&self, first: u32, fan: &mut Fan) {
        let mut half_edge = first;
        loop {
            self.add(half_edge, fan);
            if fan.is_done() {
                return;
            }
            match self.twins.twin(previous(half_edge)) {
                Some(twin) if twin == first => return,
                Some(twin) => half_edge = twin,
                None => break,
            }
        }
        // A border: on from the other side.
        half_edge = first;
        while let Some(twin) = self.twins.twin(half_edge) {
            half_edge = next(twin);
            self.add(half_edge, fan);
            if fan.is_done() {
                return;
            }
        }
    }

    /// Adds the triangle of a half-edge as it is seen from its start.
    fn add(&self, half_edge: u32, fan: &mut Fan) {
        let [a, b, c] = self.corners(half_edge);
        let (u, v) = (b - a, c - a);
        fan.normal += u.cross(v);
        let rises = |edge: DVec3| {
            let height = edge.dot(fan.direction);
            height > 0.0 && height * height > fan.rise * fan.rise * edge.length_squared()
        };
        fan.rises |= rises(u) | rises(v);
    }

    /// The corners of the triangle, from the start of a half-edge on.
    fn corners(&self, half_edge: u32) -> [DVec3; 3] {
        let triangle = self.triangles[half_edge as usize / 3];
        let i = half_edge as usize % 3;
        [i, (i + 1) % 3, (i + 2) % 3].map(|i| self.vertices[triangle[i] as usize].as_dvec3())
    }
}

/// What is known of the triangles around a feature.
struct Fan {
    rises: bool,
    /// The sum of their normals.
    normal: DVec3,
    direction: DVec3,
    rise: f64,
    is_hasty: bool,
}

impl Fan {
    /// Whether no more needs to be known.
    fn is_done(&self) -> bool {
        self.is_hasty && self.rises
    }
}

fn next(half_edge: u32) -> u32 {
    if half_edge % 3 == 2 { half_edge - 2 } else { half_edge + 1 }
}

fn previous(half_edge: u32) -> u32 {
    if half_edge.is_multiple_of(3) { half_edge + 2 } else { half_edge - 1 }
}
