//! What one world was answered, for another that is its equal.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, PoisonError};

use rapier3d::geometry::{ContactData, ContactManifold, ContactManifoldData};
use rapier3d::math::{Pose, Real, Vector};
use rapier3d::parry::query::details::{
    NormalConstraints, ShapeCastOptions, VoxelsShapeContactManifoldsWorkspace,
};
use rapier3d::parry::query::{
    ClosestPoints, Contact, ContactManifoldsWorkspace, NonlinearRigidMotion,
    PersistentQueryDispatcher, QueryDispatcher, ShapeCastHit, ShapeDistance, ShapeIntersection,
    Unsupported,
};
use rapier3d::parry::shape::Shape;

use super::SharedDispatcher;
use super::timed::{forward, forward_pair, forward_queries};

/// Manifolds of queries, in the order in which they were asked for; clones share them.
#[derive(Clone, Default)]
pub struct Tape(Arc<Mutex<VecDeque<Vec<ContactManifold>>>>);

/// A dispatcher that records its answers, or plays those of another one.
pub struct Taped {
    tape: Tape,
    inner: SharedDispatcher,
    plays: bool,
}

impl Taped {
    /// Answers as `inner`, and records that.
    pub fn recording(tape: &Tape, inner: SharedDispatcher) -> Self {
        Self { tape: tape.clone(), inner, plays: false }
    }

    /// Writes what was recorded, with no search at all: the least that any dispatcher must do for
    /// these manifolds. Where nothing is left `inner` answers.
    pub fn playing(tape: &Tape, inner: SharedDispatcher) -> Self {
        Self { tape: tape.clone(), inner, plays: true }
    }
}

impl QueryDispatcher for Taped {
    forward_queries!();
}

impl PersistentQueryDispatcher<ContactManifoldData, ContactData> for Taped {
    fn contact_manifolds(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
        prediction: Real,
        manifolds: &mut Vec<ContactManifold>,
        workspace: &mut Option<ContactManifoldsWorkspace>,
    ) -> Result<(), Unsupported> {
        let tape = || self.tape.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(answer) = self.plays.then(|| tape().pop_front()).flatten() {
            write(&answer, manifolds);
            // Rapier looks whether there is one: it keeps count of manifolds that come and go.
            let any = || Box::new(VoxelsShapeContactManifoldsWorkspace::<2>::new());
            workspace.get_or_insert_with(|| ContactManifoldsWorkspace(any()));
            return Ok(());
        }
        let result = self.inner.contact_manifolds(pos12, g1, g2, prediction, manifolds, workspace);
        if !self.plays {
            tape().push_back(manifolds.clone());
        }
        result
    }

    forward_pair!(ContactManifoldData, ContactData);
}

/// Turns `manifolds` into `answer`, and allocates only for what grows. What Rapier keeps in them of its
/// own world stays.
fn write(answer: &[ContactManifold], manifolds: &mut Vec<ContactManifold>) {
    manifolds.resize_with(answer.len(), ContactManifold::new);
    for (manifold, answer) in manifolds.iter_mut().zip(answer) {
        manifold.points.clear();
        manifold.points.extend_from_slice(&answer.points);
        (manifold.local_n1, manifold.local_n2) = (answer.local_n1, answer.local_n2);
        (manifold.subshape1, manifold.subshape2) = (answer.subshape1, answer.subshape2);
        manifold.set_subshape_pos1(answer.subshape_pos1().copied());
        manifold.set_subshape_pos2(answer.subshape_pos2().copied());
    }
}
