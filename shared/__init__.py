"""What every process shares: messages, topics, the codec, the bus, life cycle and geometry."""
