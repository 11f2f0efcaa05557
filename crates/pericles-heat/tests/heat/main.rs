//! Heat conduction: operator, schemes, conservation, closed forms.

mod closed_forms;
mod divided;
mod operator;
mod schemes;
mod support;
mod surfaces;
mod system;
