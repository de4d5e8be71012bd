"""What comes and goes over the network: bodies of requests, answers, events, who may ask."""
