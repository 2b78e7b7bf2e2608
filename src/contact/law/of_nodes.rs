//! The contacts of each node, by which threads add up what they do, in the order in which one thread would.

use super::Contact;
use crate::backend::cpu::Cpu;
use glam::{DVec3, DVec4};

/// Nodes that a task works on.
const NODES_A_TASK: usize = 256;

/// Contacts by node.
#[derive(Clone, Debug, Default)]
pub(super) struct OfNodes {
    /// Where each node's contacts begin, and where the last one's end; empty where nothing is listed.
    starts: Vec<u32>,
    /// Their numbers among all, ascending, with the weights of the node.
    contacts: Vec<(u32, f64)>,
}

impl OfNodes {
    /// Whether nothing is listed.
    pub fn is_empty(&self) -> bool {
        self.starts.is_empty()
    }

    /// Lists nothing any more.
    pub fn clear(&mut self) {
        self.starts.clear();
        self.contacts.clear();
    }

    /// Bytes that they take.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.starts[..]) + size_of_val(&self.contacts[..])
    }

    /// Lists contacts, of so many nodes.
    pub fn list(&mut self, batches: &[Vec<Contact>], nodes: usize) {
        self.clear();
        let Self { starts, contacts: listed } = self;
        let contacts = || batches.iter().flatten();
        starts.resize(nodes + 1, 0);
        contacts().for_each(|contact| contact.parts.iter().for_each(|(node, _)| starts[node + 1] += 1));
        (0..nodes).for_each(|node| starts[node + 1] += starts[node]);
        listed.resize(starts[nodes] as usize, (0, 0.0));
        // the start of each node runs to its end, which is the next one's start
        for (number, contact) in (0..).zip(contacts()) {
            for (node, weight) in contact.parts.iter() {
                listed[starts[node] as usize] = (number, weight);
                starts[node] += 1;
            }
        }
        starts.rotate_right(1);
        starts[0] = 0;
    }

    fn of(&self, node: usize) -> &[(u32, f64)] {
        &self.contacts[self.starts[node] as usize..self.starts[node + 1] as usize]
    }

    /// Adds to each node the weights of its contacts.
    pub fn share(&self, shares: &mut [f64], cpu: &Cpu) {
        self.each(shares, cpu, |node, share| self.of(node).iter().for_each(|(_, weight)| *share += weight.abs()));
    }

    /// Adds to each node what forces of its contacts (N) come to there.
    pub fn add(
        &self,
        forces: &[DVec3],
        nodes: &mut [DVec4],
        cpu: &Cpu,
        comes_to: impl Fn(usize, DVec4) -> DVec4 + Sync + Send,
    ) {
        self.each(nodes, cpu, |node, sum| {
            for &(contact, weight) in self.of(node) {
                let force = forces[contact as usize];
                if force != DVec3::ZERO {
                    *sum += comes_to(node, (force * weight).extend(0.0));
                }
            }
        });
    }

    fn each<T: Send>(&self, nodes: &mut [T], cpu: &Cpu, work: impl Fn(usize, &mut T) + Sync + Send) {
        cpu.for_each(nodes.chunks_mut(NODES_A_TASK).enumerate(), |(task, nodes)| {
            (task * NODES_A_TASK..).zip(nodes).for_each(|(node, of_node)| work(node, of_node));
        });
    }
}
