//! Messages between the first process and all others.

use super::Comm;

/// Sends a message to the first process, which receives the messages of all processes in the order of ranks; `None` on the others.
/// All processes must call it together.
pub fn collect(comm: &dyn Comm, message: Vec<f64>) -> Option<Vec<Vec<f64>>> {
    if comm.rank() > 0 {
        comm.exchange(&[0], &[message], &mut [Vec::new()]);
        return None;
    }
    let others: Vec<usize> = (1..comm.size()).collect();
    let mut messages = vec![message];
    messages.resize(comm.size(), Vec::new());
    let nothing = vec![Vec::new(); others.len()];
    comm.exchange(&others, &nothing, &mut messages[1..]);
    Some(messages)
}

/// Returns a text as a message, see [`text_of`].
pub fn text_message(text: &str) -> Vec<f64> {
    text.bytes().map(f64::from).collect()
}

/// Returns the text of a message of [`text_message`].
pub fn text_of(message: &[f64]) -> String {
    let bytes: Vec<u8> = message.iter().map(|&byte| byte as u8).collect();
    String::from_utf8_lossy(&bytes).into_owned()
}

/// Sends `messages[k]` from the first process, which passes one per process, to process k, and returns the message of this
/// process. All processes must call it together.
///
/// # Panics
/// If the first process does not pass one message per process.
pub fn distribute(comm: &dyn Comm, messages: Option<Vec<Vec<f64>>>) -> Vec<f64> {
    if comm.rank() > 0 {
        let mut received = [Vec::new()];
        comm.exchange(&[0], &[Vec::new()], &mut received);
        return std::mem::take(&mut received[0]);
    }
    let mut messages = messages.unwrap_or_default();
    assert_eq!(messages.len(), comm.size(), "one message per process");
    let others: Vec<usize> = (1..comm.size()).collect();
    let mut received = vec![Vec::new(); others.len()];
    comm.exchange(&others, &messages[1..], &mut received);
    messages.swap_remove(0)
}
