//! What a finding can be about: a fault or a caution.

use std::error::Error;

use miette::Severity;

/// What a finding can be about.
pub trait Subject: Error + 'static {
    /// How bad it is.
    const SEVERITY: Severity;

    /// What is allowed instead or can be done, if the text of the subject does not say so itself.
    fn advice(&self) -> Option<String>;

    /// A few words beside the marked text.
    fn label(&self) -> &'static str;
}
