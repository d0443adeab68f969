//! A polytope of points of the difference that grows around the origin.

use super::simplex::{self, thin_normal};
use super::support::Vertex;
use arrayvec::ArrayVec;
use glamx::DVec3;

/// Vertices at most.
const VERTICES: usize = 256;

/// Faces of a closed surface of as many vertices.
const FACES: usize = 2 * VERTICES;

/// A triangle of the surface, counterclockwise from outside.
#[derive(Clone, Copy)]
pub(super) struct Face {
    pub vertices: [u16; 3],
    /// The face across the edge from each vertex to the next.
    pub neighbors: [u16; 3],
    pub normal: DVec3,
    /// Distance of the plane from the origin.
    pub distance: f64,
    state: State,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum State {
    Open,
    /// Part of the surface; not to be looked at again.
    Closed,
    /// Seen from the new vertex, so that it will go.
    Seen,
    Gone,
}

/// An edge between the faces visible from a new vertex and the others, with the face behind it.
#[derive(Clone, Copy)]
struct HorizonEdge {
    start: u16,
    end: u16,
    behind: u16,
}

/// A closed surface of triangles.
pub(super) struct Polytope {
    vertices: ArrayVec<Vertex, VERTICES>,
    faces: ArrayVec<Face, FACES>,
    /// Their distances, infinite for those that are not open: side by side, as all are looked
    /// through for each new vertex.
    open: ArrayVec<f64, FACES>,
    gone: ArrayVec<u16, FACES>,
    /// Points above a plane by less than this count as in it.
    slack: f64,
}

const NO_FACE: u16 = u16::MAX;

impl Polytope {
    /// Without faces. `slack` is what rounding does to distances.
    #[inline(always)]
    pub fn empty(slack: f64) -> Self {
        Self {
            vertices: ArrayVec::new(),
            faces: ArrayVec::new(),
            open: ArrayVec::new(),
            gone: ArrayVec::new(),
            slack,
        }
    }

    /// Makes an empty one a tetrahedron, its vertices in any order. (To return it from here would
    /// copy 45 kB.)
    pub fn begin(&mut self, [a, b, c, d]: [Vertex; 4]) {
        let volume = (b.point - a.point).cross(c.point - a.point).dot(d.point - a.point);
        // Seen from d, the face a, b, c must turn clockwise.
        let vertices = if volume > 0.0 { [a, c, b, d] } else { [a, b, c, d] };
        self.vertices.extend(vertices);
        let faces = [
            ([0, 1, 2], [1, 2, 3]),
            ([1, 0, 3], [0, 3, 2]),
            ([2, 1, 3], [0, 1, 3]),
            ([0, 2, 3], [0, 2, 1]),
        ];
        for (vertices, neighbors) in faces {
            let face = self.face(vertices, neighbors);
            self.put(self.faces.len(), face);
        }
    }

    /// The open face whose plane is nearest to the origin.
    pub fn nearest_open(&self) -> Option<usize> {
        let least =
            self.open.iter().fold(f64::INFINITY, |least, &x| if x < least { x } else { least });
        (least < f64::INFINITY).then(|| self.open.iter().position(|&x| x == least))?
    }

    /// An open face.
    pub fn first_open(&self) -> Option<usize> {
        self.open.iter().position(|&x| x < f64::INFINITY)
    }

    /// Writes a face to a place in the list, or behind its end.
    fn put(&mut self, place: usize, face: Face) {
        let open = if face.state == State::Open { face.distance } else { f64::INFINITY };
        match self.faces.get_mut(place) {
            Some(old) => (*old, self.open[place]) = (face, open),
            None => {
                self.faces.push(face);
                self.open.push(open);
            }
        }
    }

    pub fn get(&self, face: usize) -> &Face {
        &self.faces[face]
    }

    /// The faces of the surface, and their places in the list.
    pub fn faces(&self) -> impl Iterator<Item = (usize, &Face)> {
        let is_part = |face: &Face| matches!(face.state, State::Open | State::Closed);
        self.faces.iter().enumerate().filter(move |(_, face)| is_part(face))
    }

    pub fn close(&mut self, face: usize) {
        self.faces[face].state = State::Closed;
        self.open[face] = f64::INFINITY;
    }

    pub fn corners(&self, face: &Face) -> [Vertex; 3] {
        face.vertices.map(|v| self.vertices[usize::from(v)])
    }

    /// Adds a vertex that is above a face: removes the visible faces and connects the horizon with
    /// the vertex. Returns false, without changes, if there is no room or if rounding made the
    /// horizon no simple loop.
    pub fn expand(&mut self, face: usize, new: Vertex) -> bool {
        if self.vertices.is_full() {
            return false;
        }
        let mut seen = ArrayVec::<u16, FACES>::new();
        let mut horizon = ArrayVec::<HorizonEdge, FACES>::new();
        let states = self.look(face, new.point, &mut seen, &mut horizon);
        if !is_loop(&horizon) {
            for (&i, &state) in seen.iter().zip(&states) {
                self.faces[usize::from(i)].state = state;
            }
            return false;
        }
        for &i in &seen {
            self.faces[usize::from(i)].state = State::Gone;
            self.open[usize::from(i)] = f64::INFINITY;
            self.gone.push(i);
        }
        self.vertices.push(new);
        self.cover(&horizon);
        true
    }

    /// Marks the faces below a point that hang together with the given one, and lists them, their
    /// states before, and the edges around them.
    fn look(
        &mut self,
        face: usize,
        point: DVec3,
        seen: &mut ArrayVec<u16, FACES>,
        horizon: &mut ArrayVec<HorizonEdge, FACES>,
    ) -> ArrayVec<State, FACES> {
        let mut states = ArrayVec::new();
        let mut mark = |face: &mut Face| {
            states.push(face.state);
            face.state = State::Seen;
        };
        mark(&mut self.faces[face]);
        seen.push(face as u16);
        let mut next = 0;
        while next < seen.len() {
            let current = self.faces[usize::from(seen[next])];
            next += 1;
            for &i in &current.neighbors {
                let neighbor = &mut self.faces[usize::from(i)];
                let is_below = neighbor.normal.dot(point) > neighbor.distance + self.slack;
                if neighbor.state != State::Seen && is_below {
                    mark(neighbor);
                    seen.push(i);
                }
            }
        }
        for &i in seen.iter() {
            let current = self.faces[usize::from(i)];
            for edge in 0..3 {
                let behind = current.neighbors[edge];
                if self.faces[usize::from(behind)].state != State::Seen {
                    let (start, end) = (current.vertices[edge], current.vertices[(edge + 1) % 3]);
                    if horizon.try_push(HorizonEdge { start, end, behind }).is_err() {
                        horizon.clear();
                        return states;
                    }
                }
            }
        }
        states
    }

    /// Spans faces from the last vertex to the edges of a loop.
    fn cover(&mut self, horizon: &[HorizonEdge]) {
        let top = (self.vertices.len() - 1) as u16;
        let mut starting_at = [NO_FACE; VERTICES];
        for &HorizonEdge { start, end, behind } in horizon {
            let face = self.face([start, end, top], [behind, NO_FACE, NO_FACE]);
            let slot = self.gone.pop().unwrap_or(self.faces.len() as u16);
            self.put(usize::from(slot), face);
            starting_at[usize::from(start)] = slot;
            let across = &mut self.faces[usize::from(behind)];
            for edge in 0..3 {
                if across.vertices[edge] == end && across.vertices[(edge + 1) % 3] == start {
                    across.neighbors[edge] = slot;
                }
            }
        }
        for edge in horizon {
            let (own, next) =
                (starting_at[usize::from(edge.start)], starting_at[usize::from(edge.end)]);
            self.faces[usize::from(own)].neighbors[1] = next;
            self.faces[usize::from(next)].neighbors[2] = own;
        }
    }

    /// A face without area lies along the first edge of another one and shares its plane.
    fn face(&self, vertices: [u16; 3], neighbors: [u16; 3]) -> Face {
        // Written out: `array::map` is not always inlined, and then written and read again.
        let point = |v: u16| self.vertices[usize::from(v)].point;
        let (a, b, c) = (point(vertices[0]), point(vertices[1]), point(vertices[2]));
        if let Some((normal, squared)) = thin_normal([a, b, c]) {
            let normal = normal / squared.sqrt();
            let distance = (normal.dot(a) + normal.dot(b) + normal.dot(c)) / 3.0;
            return Face { vertices, neighbors, normal, distance, state: State::Open };
        }
        let (normal, distance) = self
            .faces
            .get(usize::from(neighbors[0]))
            .map_or((DVec3::ZERO, 0.0), |behind| (behind.normal, behind.distance));
        Face { vertices, neighbors, normal, distance, state: State::Closed }
    }

    /// Squared distance of the nearest point of a face from a point, and that point's share of the
    /// corners of the triangle.
    pub fn nearest_to(&self, point: DVec3, face: &Face, corners: &[DVec3; 3]) -> (f64, DVec3) {
        let [a, b, c] =
            self.corners(face).map(|v| Vertex { point: v.point - point, corner: v.corner });
        let nearest = simplex::face(a, b, c);
        (nearest.squared, nearest.on_triangle(corners))
    }
}

/// True if the edges form one loop without repeated vertices.
fn is_loop(edges: &[HorizonEdge]) -> bool {
    let Some(first) = edges.first() else { return false };
    let mut end_of = [NO_FACE; VERTICES];
    for edge in edges {
        let end = &mut end_of[usize::from(edge.start)];
        if *end != NO_FACE {
            return false;
        }
        *end = edge.end;
    }
    let (mut at, mut steps) = (first.end, 1);
    while at != first.start && steps < edges.len() {
        at = end_of[usize::from(at)];
        if at == NO_FACE {
            return false;
        }
        steps += 1;
    }
    at == first.start && steps == edges.len()
}
