use crate::prelude::*;
use rapier3d::parry::shape::HeightFieldCellStatus;

/// A field, and the mesh of its triangles in the order of their numbers.
pub struct Terrain {
    pub field: HeightField,
    pub mesh: TriMesh,
    /// The number in the field of each triangle of the mesh, ascending.
    pub ids: Vec<u32>,
}

impl Terrain {
    pub fn new(field: HeightField) -> Self {
        let all = 0..2 * (field.nrows() * field.ncols()) as u32;
        let triangles = all.filter_map(|id| Some((id, field.triangle_at_id(id)?)));
        let is_finite = |corner: &Vec3| corner.is_finite();
        let (ids, corners): (Vec<_>, Vec<_>) = triangles
            .map(|(id, triangle)| (id, *triangle.vertices()))
            .filter(|(_, corners)| corners.iter().all(is_finite))
            .unzip();
        let indices = (0..ids.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]);
        let mesh = TriMesh::new(corners.concat(), indices.collect()).unwrap();
        Self { field, mesh, ids }
    }

    /// Hills at random, `cells` along z and x, with every kind of cell.
    pub fn random(random: &mut Rand32, cells: [usize; 2], scale: Vec3) -> Self {
        let heights = heights(cells, || random.rand_float() - 0.5);
        let mut field = HeightField::new(heights, scale);
        for i in 0..cells[0] {
            for j in 0..cells[1] {
                let bits = [random.rand_range(0..2), u32::from(random.rand_range(0..8) == 0)];
                let status = HeightFieldCellStatus::from_bits_truncate(
                    (bits[0] | (bits[1] * (2 << random.rand_range(0..2)))) as u8,
                );
                field.set_cell_status(i, j, status);
            }
        }
        field.set_cell_status(cells[0] / 2, 0, HeightFieldCellStatus::CELL_REMOVED);
        Self::new(field)
    }

    /// The question with the terrain as a mesh.
    pub fn as_mesh<'a>(&'a self, question: &Question<'a>) -> Question<'a> {
        Question { shapes: [&self.mesh, question.shapes[1]], ..*question }
    }

    /// Renumbers triangles of the field as triangles of the mesh.
    pub fn renumbered(&self, question: &Question, manifolds: &[Manifold]) -> Vec<Manifold> {
        let mut manifolds = manifolds.to_vec();
        for Manifold { subshape1, subshape2, .. } in &mut manifolds {
            let id = if question.is_flipped { subshape2 } else { subshape1 };
            *id = self.ids.binary_search(id).expect("a triangle of the field") as u32;
        }
        manifolds
    }

    /// Steps, plains and cliffs: heights that are whole multiples of a quarter, cells of a half.
    pub fn lattice(random: &mut Rand32) -> Self {
        let heights = heights([12, 16], || random.rand_range(0..3) as Real * 0.25);
        Self::new(HeightField::new(heights, Vec3::new(8.0, 1.0, 6.0)))
    }
}

pub(super) fn terrains() -> Vec<Terrain> {
    let mut random = Rand32::new(1);
    vec![
        Terrain::random(&mut random, [14, 17], Vec3::new(6.0, 1.0, 4.0)),
        Terrain::random(&mut random, [1, 2], Vec3::new(4.0, 0.5, 5.0)),
        Terrain::random(&mut random, [30, 20], Vec3::new(3.0, 2.0, 3.0)),
        Terrain::random(&mut random, [8, 9], Vec3::new(-4.0, -0.7, 5.0)),
        Terrain::lattice(&mut random),
        Terrain::new(rolling(6.0, 20, 0.5)),
    ]
}

/// Draws the heights of a field of so many cells along z and x.
pub(super) fn heights(cells: [usize; 2], mut draw: impl FnMut() -> Real) -> Array2<Real> {
    let [rows, columns] = cells.map(|cells| cells + 1);
    Array2::new(rows, columns, (0..rows * columns).map(|_| draw()).collect())
}

/// The terrain of the laboratory as a field.
pub fn rolling(size: Real, cells: u32, height: Real) -> HeightField {
    let mesh = mesh::terrain(size, cells, height);
    let lines = cells as usize + 1;
    let heights = Array2::from_fn(lines, lines, |i, j| mesh.vertices[i * lines + j].y);
    let mut field = HeightField::new(heights, Vec3::new(size, 1.0, size));
    for status in field.cells_statuses_mut().data_mut() {
        *status = HeightFieldCellStatus::ZIGZAG_SUBDIVISION;
    }
    field
}

/// A pose at which the mesh touches the terrain.
pub(super) fn place(random: &mut Rand32, terrain: &Terrain, mesh: &TriMesh, depth: Real) -> Pose {
    let pose = touching(random, [&terrain.mesh, mesh], depth);
    if random.rand_range(0..3) == 0 {
        return pose;
    }
    let box_ = terrain.field.root_aabb();
    let [x, z] = [0, 2].map(|axis| 2.0 * box_.half_extents()[axis] * (random.rand_float() - 0.5));
    Pose::from_parts(Vec3::new(x, pose.translation.y, z), pose.rotation)
}
