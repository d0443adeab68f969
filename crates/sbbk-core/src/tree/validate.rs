use glamx::Vec3;

use super::Tree;
use super::node::{LeafBatch, Slot};

/// A fault of a tree.
#[derive(Clone, Debug, PartialEq)]
pub enum Violation {
    /// A node or leaf is reached twice or does not exist.
    Topology,
    /// Some nodes or leaves are not reachable from the root.
    Unreachable,
    /// This triangle is missing, in two leaves, or beyond the mesh.
    Triangle(u32),
    /// A volume does not contain a corner of this triangle below it.
    NotContained(u32),
}

impl Tree {
    /// Checks topology, completeness and that each volume of each layer contains every corner below
    /// it. For tests: takes the number of triangles times the depth.
    ///
    /// # Errors
    /// The first violation. A tree from [`Tree::build`] has none.
    pub fn validate(&self) -> Result<(), Violation> {
        let mut is_seen = [vec![false; self.node_count()], vec![false; self.leaves.len()]];
        let mut is_found = vec![false; self.triangle_count as usize];
        is_seen[0][0] = true;
        let mut stack = vec![vec![Slot::ROOT]];
        while let Some(path) = stack.pop() {
            let link = self.link(*path.last().expect("a path starts at the root"));
            match is_seen[usize::from(link.is_leaf())].get_mut(link.index() as usize) {
                Some(is_seen @ false) => *is_seen = true,
                _ => return Err(Violation::Topology),
            }
            if link.is_leaf() {
                self.validate_leaf(self.leaf(link.index()), &path, &mut is_found)?;
            } else {
                let below = |lane| [&path[..], &[Slot::new(link.index(), lane)]].concat();
                stack.extend([below(0), below(1)]);
            }
        }
        if is_seen.iter().flatten().any(|&is_seen| !is_seen) {
            return Err(Violation::Unreachable);
        }
        let lost = is_found.iter().position(|&is_found| !is_found);
        lost.map_or(Ok(()), |triangle| Err(Violation::Triangle(triangle as u32)))
    }

    fn validate_leaf(
        &self,
        batch: &LeafBatch,
        path: &[Slot],
        is_found: &mut [bool],
    ) -> Result<(), Violation> {
        for (lane, &triangle) in batch.triangles().iter().enumerate() {
            match is_found.get_mut(triangle as usize) {
                Some(is_found @ false) => *is_found = true,
                _ => return Err(Violation::Triangle(triangle)),
            }
            let is_inside = |corner: Vec3| {
                let in_node = |slot: &Slot| {
                    let children = self.children(slot.node());
                    let kdop = children.kdop(slot.lane());
                    children.aabb(slot.lane()).contains(corner)
                        && kdop.is_none_or(|kdop| kdop.contains(corner))
                };
                path.iter().all(in_node) && self.sphere.is_none_or(|ball| ball.contains(corner))
            };
            if !batch.corners(lane).into_iter().all(is_inside) {
                return Err(Violation::NotContained(triangle));
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::support::bumpy_ball;
    use crate::tree::BuildOptions;
    use crate::tree::node::Link;

    /// Would catch a check that finds nothing.
    #[test]
    fn each_kind_of_damage_is_found() {
        let ball = bumpy_ball(8, 0.1);
        let whole: Tree =
            Tree::build(&ball.vertices, &ball.triangles, &BuildOptions::default()).unwrap();
        let found = |damage: &dyn Fn(&mut Tree)| {
            let mut tree = whole.clone();
            damage(&mut tree);
            tree.validate().expect_err("it is damaged")
        };
        let lost = found(&|tree| tree.aabb_pairs[0].links[0] = Link::leaf(Link::MAX_INDEX));
        assert!(matches!(lost, Violation::Topology), "{lost:?}");
        let left_over = found(&|tree| tree.leaves.push(tree.leaves[0]));
        assert!(matches!(left_over, Violation::Unreachable), "{left_over:?}");
        let renamed = found(&|tree| tree.leaves[0].triangles = tree.leaves[1].triangles);
        assert!(matches!(renamed, Violation::Triangle(_)), "{renamed:?}");
        // The root, a diagonal slab, and the sphere.
        for damage in [
            &|tree: &mut Tree| tree.aabb_pairs[0].centre[0][0] += 1.0,
            &|tree: &mut Tree| tree.kdop_pairs[0].centre[3] = [9.0; 2],
            &|tree: &mut Tree| tree.sphere.as_mut().unwrap().radius *= 0.5,
        ] as [&dyn Fn(&mut Tree); 3]
        {
            let outside = found(damage);
            assert!(matches!(outside, Violation::NotContained(_)), "{outside:?}");
        }
    }
}
