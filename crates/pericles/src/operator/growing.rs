//! Forces whose bonds come into being during a run.

/// A force whose bonds exist from the time at which both of their ends are active; see
/// [`System::add_activation`](crate::System::add_activation). Points are given with the ghosts after the own points.
pub trait Growing {
    /// Prepares the force, before a state is taken over or restored.
    fn grow(&mut self);

    /// Removes the bonds that have an end that is not active at the start of the run.
    fn start_with(&mut self, active: &[bool]);

    /// Reads which bonds do not exist yet, after the bonds were restored.
    fn note_active(&mut self, active: &[bool]);

    /// Adds the bonds whose ends have both become active, free of force at time t and displacement u. All processes must
    /// call it together.
    fn activate(&mut self, t: f64, u: &[f64], active: &[bool]);

    /// Calls `visit` with each point that a bond joins to own point i as soon as both are active, and with the vector ξ to
    /// it.
    fn for_each_neighbour(&self, i: usize, visit: &mut dyn FnMut(usize, [f64; 3]));
}
