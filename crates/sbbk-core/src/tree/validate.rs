use super::Tree;
use super::node::{Link, Slot};

/// The first thing found wrong with a tree.
#[derive(Clone, Debug, PartialEq)]
pub enum Violation {
    /// A slot is reached twice, or leads to a number that does not exist.
    Topology {
        /// The slot.
        slot: Slot,
    },
    /// Some nodes or leaves are not reachable from the root.
    Unreachable {
        /// Inner nodes reached, the root's own entry included.
        nodes: usize,
        /// Leaves reached.
        leaves: usize,
    },
    /// A triangle is missing or in two leaves.
    Triangles {
        /// The triangle's index in the mesh.
        triangle: u32,
        /// In how many leaves it is.
        occurrences: u32,
    },
    /// A node's volume does not contain a corner of a triangle below it.
    NotContained {
        /// The node.
        slot: Slot,
        /// The triangle's index in the mesh.
        triangle: u32,
    },
}

impl Tree {
    /// Checks topology, completeness and that each volume of each layer contains every corner below
    /// it. Costs triangles times depth: for tests and for finding out.
    ///
    /// # Errors
    /// The first violation found. A tree from [`Tree::build`] has none.
    pub fn validate(&self) -> Result<(), Violation> {
        let mut seen_nodes = vec![false; self.node_count()];
        let mut seen_leaves = vec![false; self.leaves.len()];
        let mut occurrences = vec![0u32; self.triangle_count as usize];
        seen_nodes[0] = true;
        let mut stack = vec![vec![Slot::ROOT]];
        while let Some(path) = stack.pop() {
            let slot = *path.last().expect("a path starts at the root");
            let link = self.link(slot);
            let seen = if link.is_leaf() { &mut seen_leaves } else { &mut seen_nodes };
            match seen.get_mut(link.index() as usize) {
                Some(seen @ false) => *seen = true,
                _ => return Err(Violation::Topology { slot }),
            }
            if link.is_leaf() {
                self.validate_leaf(link, &path, &mut occurrences)?;
            } else {
                for lane in 0..2 {
                    let mut below = path.clone();
                    below.push(Slot::new(link.index(), lane));
                    stack.push(below);
                }
            }
        }
        let count = |seen: &[bool]| seen.iter().filter(|&&seen| seen).count();
        let (nodes, leaves) = (count(&seen_nodes), count(&seen_leaves));
        if nodes != seen_nodes.len() || leaves != seen_leaves.len() {
            return Err(Violation::Unreachable { nodes, leaves });
        }
        match occurrences.iter().position(|&n| n != 1) {
            Some(i) => {
                Err(Violation::Triangles { triangle: i as u32, occurrences: occurrences[i] })
            }
            None => Ok(()),
        }
    }

    fn validate_leaf(
        &self,
        link: Link,
        path: &[Slot],
        occurrences: &mut [u32],
    ) -> Result<(), Violation> {
        let batch = self.leaf(link.index());
        for (lane, &triangle) in batch.triangles().iter().enumerate() {
            match occurrences.get_mut(triangle as usize) {
                Some(occurrences) => *occurrences += 1,
                None => {
                    return Err(Violation::Triangles { triangle, occurrences: 0 });
                }
            }
            for &slot in path {
                let children = self.children(slot.node());
                let aabb = children.aabb(slot.lane());
                let kdop = children.kdop(slot.lane());
                let inside = |p| aabb.contains(p) && kdop.is_none_or(|kdop| kdop.contains(p));
                if !batch.corners(lane).into_iter().all(inside) {
                    return Err(Violation::NotContained { slot, triangle });
                }
            }
        }
        match self.sphere {
            Some(sphere) => match (0..batch.count())
                .find(|&lane| !batch.corners(lane).into_iter().all(|p| sphere.contains(p)))
            {
                Some(lane) => Err(Violation::NotContained {
                    slot: Slot::ROOT,
                    triangle: batch.triangles()[lane],
                }),
                None => Ok(()),
            },
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::support::bumpy_ball;
    use crate::tree::BuildOptions;

    /// Would catch a check that passes over what it is there for.
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
        assert!(matches!(lost, Violation::Topology { .. }), "{lost:?}");
        let left_over = found(&|tree| tree.leaves.push(tree.leaves[0]));
        assert!(matches!(left_over, Violation::Unreachable { .. }), "{left_over:?}");
        let renamed = found(&|tree| tree.leaves[0].triangles = tree.leaves[1].triangles);
        assert!(matches!(renamed, Violation::Triangles { .. }), "{renamed:?}");
        // The root, a slab of a k-DOP that is none of its box, and the sphere.
        for damage in [
            &|tree: &mut Tree| tree.aabb_pairs[0].centre[0][0] += 1.0,
            &|tree: &mut Tree| tree.kdop_pairs[0].centre[3] = [9.0; 2],
            &|tree: &mut Tree| tree.sphere.as_mut().unwrap().radius *= 0.5,
        ] as [&dyn Fn(&mut Tree); 3]
        {
            let outside = found(damage);
            assert!(matches!(outside, Violation::NotContained { .. }), "{outside:?}");
        }
    }
}
